// Swapchains, and what is done with what was drawn into them.
#include <epoxy/gl.h>

#include <cstdio>
#include <cstring>

#include "tests/xr/runtime/runtime.h"

namespace slosh::xr_test {
namespace {

XrResult formats(XrSession, std::uint32_t room, std::uint32_t* count, std::int64_t* out) {
  *count = 2;
  if (room >= 2) {
    out[0] = GL_SRGB8_ALPHA8;
    out[1] = GL_RGBA16F;
  }
  return XR_SUCCESS;
}

XrResult create_chain(XrSession, const XrSwapchainCreateInfo* info, XrSwapchain* chain) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (refuse("xrCreateSwapchain")) return XR_ERROR_RUNTIME_FAILURE;
  Chain made;
  made.width = static_cast<int>(info->width);
  made.height = static_cast<int>(info->height);
  made.textures.resize(3);
  glCreateTextures(GL_TEXTURE_2D, 3, made.textures.data());
  for (const std::uint32_t texture : made.textures)
    glTextureStorage2D(texture, 1, static_cast<GLenum>(info->format), made.width, made.height);
  *chain = handle_of<XrSwapchain>(++s.last_handle);
  s.chains[s.last_handle] = made;
  s.log.say("swapchain %llu %d x %d", static_cast<unsigned long long>(s.last_handle), made.width,
            made.height);
  return XR_SUCCESS;
}

XrResult destroy_chain(XrSwapchain chain) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  const auto found = s.chains.find(number_of(chain));
  if (found == s.chains.end()) return wrong("a swapchain destroyed twice", XR_ERROR_HANDLE_INVALID);
  glDeleteTextures(3, found->second.textures.data());
  s.chains.erase(found);
  return XR_SUCCESS;
}

XrResult images(XrSwapchain chain, std::uint32_t room, std::uint32_t* count,
                XrSwapchainImageBaseHeader* out) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  const Chain& c = s.chains[number_of(chain)];
  *count = 3;
  auto* images_out = reinterpret_cast<XrSwapchainImageOpenGLKHR*>(out);
  for (std::uint32_t i = 0; i < 3 && room >= 3; ++i) images_out[i].image = c.textures[i];
  return XR_SUCCESS;
}

XrResult acquire(XrSwapchain chain, const XrSwapchainImageAcquireInfo*, std::uint32_t* index) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (refuse("xrAcquireSwapchainImage")) return XR_ERROR_RUNTIME_FAILURE;
  Chain& c = s.chains[number_of(chain)];
  if (c.acquired >= 0) return wrong("a swapchain acquired twice", XR_ERROR_CALL_ORDER_INVALID);
  if (!s.begun) wrong("a swapchain acquired outside of a frame", XR_SUCCESS);
  c.acquired = static_cast<int>(c.next++ % 3);
  c.waited = false;
  *index = static_cast<std::uint32_t>(c.acquired);
  return XR_SUCCESS;
}

XrResult wait(XrSwapchain chain, const XrSwapchainImageWaitInfo*) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  Chain& c = s.chains[number_of(chain)];
  if (c.acquired < 0)
    return wrong("a swapchain waited for before it was acquired", XR_ERROR_CALL_ORDER_INVALID);
  if (refuse("xrWaitSwapchainImage")) {
    c.waited = true;
    return XR_ERROR_RUNTIME_FAILURE;
  }
  c.waited = true;
  return XR_SUCCESS;
}

XrResult release(XrSwapchain chain, const XrSwapchainImageReleaseInfo*) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  Chain& c = s.chains[number_of(chain)];
  if (c.acquired < 0 || !c.waited)
    return wrong("a swapchain released before it was waited for", XR_ERROR_CALL_ORDER_INVALID);
  c.released = c.acquired;
  c.acquired = -1;
  return XR_SUCCESS;
}

/// Bottom row first as it lies there; a .ppm begins at the top.
std::vector<std::uint8_t> pixels(const Chain& c) {
  std::vector<std::uint8_t> rgba(std::size_t{4} * static_cast<std::size_t>(c.width * c.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(c.textures[static_cast<std::size_t>(c.released)], 0, GL_RGBA, GL_UNSIGNED_BYTE,
                    static_cast<GLsizei>(rgba.size()), rgba.data());
  return rgba;
}

void keep(const Chain& c, const char* name) {
  State& s = the();
  const std::vector<std::uint8_t> rgba = pixels(c);
  const std::filesystem::path file =
      s.script.folder / ("frame-" + std::to_string(s.frame) + "-" + name + ".ppm");
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (!out) return;
  std::fprintf(out, "P6\n%d %d\n255\n", c.width, c.height);
  for (int y = c.height - 1; y >= 0; --y) {
    for (int x = 0; x < c.width; ++x)
      std::fwrite(&rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(c.width) + x)], 1, 3,
                  out);
  }
  std::fclose(out);
}

const Chain* shown(XrSwapchain handle) {
  State& s = the();
  const auto found = s.chains.find(number_of(handle));
  if (found == s.chains.end() || found->second.released < 0) {
    wrong("a layer of a swapchain that was never released", XR_SUCCESS);
    return nullptr;
  }
  if (found->second.acquired >= 0) wrong("a layer of a swapchain that is still acquired", XR_SUCCESS);
  return &found->second;
}

XrResult end_frame(XrSession, const XrFrameEndInfo* info) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (!s.begun) return wrong("xrEndFrame without xrBeginFrame", XR_ERROR_CALL_ORDER_INVALID);
  s.begun = false;
  if (refuse("xrEndFrame")) return XR_ERROR_RUNTIME_FAILURE;
  if (info->displayTime != s.promised) wrong("a frame for another time than its own", XR_SUCCESS);
  int pairs = 0;
  int quads = 0;
  const bool kept = s.script.kept.contains(s.frame);
  for (std::uint32_t i = 0; i < info->layerCount; ++i) {
    if (info->layers[i]->type == XR_TYPE_COMPOSITION_LAYER_PROJECTION) {
      const auto* pair = reinterpret_cast<const XrCompositionLayerProjection*>(info->layers[i]);
      if (pair->viewCount != 2) wrong("a projection of other than two views", XR_SUCCESS);
      for (std::uint32_t eye = 0; eye < 2; ++eye) {
        const Chain* c = shown(pair->views[eye].subImage.swapchain);
        if (c && kept) keep(*c, eye == 0 ? "left" : "right");
      }
      ++pairs;
    }
    if (info->layers[i]->type == XR_TYPE_COMPOSITION_LAYER_QUAD) {
      const auto* quad = reinterpret_cast<const XrCompositionLayerQuad*>(info->layers[i]);
      const Chain* c = shown(quad->subImage.swapchain);
      if (c && kept) keep(*c, "panel");
      if (kept) {
        s.log.say("panel at %.3f %.3f %.3f, %.3f x %.3f m", static_cast<double>(quad->pose.position.x),
                  static_cast<double>(quad->pose.position.y), static_cast<double>(quad->pose.position.z),
                  static_cast<double>(quad->size.width), static_cast<double>(quad->size.height));
      }
      ++quads;
    }
  }
  s.log.say("end %llu pairs %d quads %d", static_cast<unsigned long long>(s.frame), pairs, quads);
  return XR_SUCCESS;
}

}  // namespace

PFN_xrVoidFunction picture_function(const std::string& name) {
#define SLOSH_IS(text, function) \
  if (name == text) return reinterpret_cast<PFN_xrVoidFunction>(function)
  SLOSH_IS("xrEnumerateSwapchainFormats", formats);
  SLOSH_IS("xrCreateSwapchain", create_chain);
  SLOSH_IS("xrDestroySwapchain", destroy_chain);
  SLOSH_IS("xrEnumerateSwapchainImages", images);
  SLOSH_IS("xrAcquireSwapchainImage", acquire);
  SLOSH_IS("xrWaitSwapchainImage", wait);
  SLOSH_IS("xrReleaseSwapchainImage", release);
  SLOSH_IS("xrEndFrame", end_frame);
#undef SLOSH_IS
  return nullptr;
}

}  // namespace slosh::xr_test
