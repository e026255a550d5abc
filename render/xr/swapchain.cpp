#include "render/xr/swapchain.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <utility>

namespace slosh::xr {
namespace {

/// A runtime that keeps an image longer than this has hung: the frame is given up, the program is not.
constexpr XrDuration kLongestWait = 500'000'000;  // ns

Result<bool> has_format(XrSession session, std::int64_t wanted) {
  std::uint32_t count = 0;
  XrResult result = xrEnumerateSwapchainFormats(session, 0, &count, nullptr);
  std::vector<std::int64_t> formats(count);
  if (XR_SUCCEEDED(result)) result = xrEnumerateSwapchainFormats(session, count, &count, formats.data());
  if (XR_FAILED(result)) return failed("xrEnumerateSwapchainFormats", result);
  return std::ranges::find(formats, wanted) != formats.end();
}

}  // namespace

Swapchain::~Swapchain() {
  if (handle_ != XR_NULL_HANDLE) xrDestroySwapchain(handle_);
}

Swapchain& Swapchain::operator=(Swapchain&& other) noexcept {
  std::swap(handle_, other.handle_);
  std::swap(size_, other.size_);
  std::swap(textures_, other.textures_);
  std::swap(acquired_, other.acquired_);
  return *this;
}

Result<Swapchain> Swapchain::create(XrSession session, glm::ivec2 size) {
  const Result<bool> srgb = has_format(session, GL_SRGB8_ALPHA8);
  if (!srgb) return srgb.error();
  if (!srgb.value())
    return Error{"headset", "the runtime offers no pictures of 8-bit sRGB (GL_SRGB8_ALPHA8)",
                 "Use another runtime"};
  auto info = typed<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
  info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
  info.format = GL_SRGB8_ALPHA8;
  info.sampleCount = 1;
  info.width = static_cast<std::uint32_t>(size.x);
  info.height = static_cast<std::uint32_t>(size.y);
  info.faceCount = info.arraySize = info.mipCount = 1;
  Swapchain made;
  made.size_ = size;
  if (const XrResult result = xrCreateSwapchain(session, &info, &made.handle_); XR_FAILED(result))
    return failed("xrCreateSwapchain", result);
  std::uint32_t count = 0;
  XrResult result = xrEnumerateSwapchainImages(made.handle_, 0, &count, nullptr);
  std::vector<XrSwapchainImageOpenGLKHR> images(count, {XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR, nullptr, 0});
  if (XR_SUCCEEDED(result)) {
    result = xrEnumerateSwapchainImages(made.handle_, count, &count,
                                        reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data()));
  }
  if (XR_FAILED(result)) return failed("xrEnumerateSwapchainImages", result);
  for (const XrSwapchainImageOpenGLKHR& image : images) made.textures_.push_back(image.image);
  return made;
}

XrResult Swapchain::acquire(std::uint32_t& texture) {
  std::uint32_t index = 0;
  XrResult result = xrAcquireSwapchainImage(handle_, nullptr, &index);
  if (XR_FAILED(result)) return result;
  acquired_ = true;
  auto wait = typed<XrSwapchainImageWaitInfo>(XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
  wait.timeout = kLongestWait;
  result = xrWaitSwapchainImage(handle_, &wait);
  if (result == XR_TIMEOUT_EXPIRED) return XR_ERROR_RUNTIME_FAILURE;
  if (XR_SUCCEEDED(result) && index < textures_.size()) texture = textures_[index];
  return result;
}

XrResult Swapchain::release() {
  acquired_ = false;
  return xrReleaseSwapchainImage(handle_, nullptr);
}

XrSwapchainSubImage Swapchain::whole() const {
  XrSwapchainSubImage part{};
  part.swapchain = handle_;
  part.imageRect.extent = {size_.x, size_.y};
  return part;
}

}  // namespace slosh::xr
