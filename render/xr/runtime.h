// The runtime that the loader finds, and the headset that it has.
#pragma once

#include <memory>
#include <string>

#include "render/xr/xr.h"

namespace slosh::xr {

/// Owns the instance: everything else of OpenXR goes before it.
class Runtime {
 public:
  /// Errors: no runtime, one without OpenGL, no headset.
  static Result<std::unique_ptr<Runtime>> find();
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  XrInstance instance() const { return instance_; }
  XrSystemId system() const { return system_; }
  bool has_egl() const { return egl_; }  ///< pictures of an EGL context
  bool has_glx() const { return glx_; }  ///< pictures of a GLX context
  const std::string& description() const { return description_; }
  /// What steady_now_ns() is in the runtime's time; 0 where it cannot say.
  XrTime now() const;

 private:
  Runtime() = default;
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  bool egl_ = false;
  bool glx_ = false;
  PFN_xrConvertTimespecTimeToTimeKHR to_time_ = nullptr;
  std::string description_;
};

}  // namespace slosh::xr
