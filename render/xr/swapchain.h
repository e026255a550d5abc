// Textures that go by turns between this program and the runtime.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render/xr/xr.h"

namespace slosh::xr {

class Swapchain {
 public:
  Swapchain() = default;
  ~Swapchain();
  Swapchain(Swapchain&& other) noexcept { *this = std::move(other); }
  Swapchain& operator=(Swapchain&& other) noexcept;

  /// Of 8-bit sRGB with alpha. Errors: the runtime has no such format, or refuses.
  static Result<Swapchain> create(XrSession session, glm::ivec2 size);

  /// The texture to draw into, after the runtime has let go of it; then release().
  XrResult acquire(std::uint32_t& texture);
  XrResult release();
  bool acquired() const { return acquired_; }
  /// All of it.
  XrSwapchainSubImage whole() const;
  glm::ivec2 size() const { return size_; }

 private:
  XrSwapchain handle_ = XR_NULL_HANDLE;
  glm::ivec2 size_{0};
  std::vector<std::uint32_t> textures_;
  bool acquired_ = false;
};

}  // namespace slosh::xr
