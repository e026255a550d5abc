#include "render/xr/runtime.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace slosh::xr {
namespace {

constexpr const char* kInstall =
    "Install one (Monado or WiVRn for most headsets, SteamVR for its own) and make it the active one, or "
    "name its "
    "manifest in XR_RUNTIME_JSON";

bool has(const std::vector<XrExtensionProperties>& all, std::string_view name) {
  return std::ranges::any_of(
      all, [&](const XrExtensionProperties& e) { return text_of(e.extensionName) == name; });
}

/// What the loader finds wrong is in our own sentence; its log would stand in the run's status line.
void quiet_loader() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): before this program's threads; a user's own setting stays
  setenv("XR_LOADER_DEBUG", "none", 0);
}

Result<std::vector<XrExtensionProperties>> extensions() {
  std::uint32_t count = 0;
  XrResult result = xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr);
  std::vector<XrExtensionProperties> all(count, {XR_TYPE_EXTENSION_PROPERTIES, nullptr, {}, 0});
  if (XR_SUCCEEDED(result)) {
    result = xrEnumerateInstanceExtensionProperties(nullptr, count, &count, all.data());
    all.resize(count);
  }
  // NOLINTNEXTLINE(concurrency-mt-unsafe): as above
  const char* named = std::getenv("XR_RUNTIME_JSON");
  if (XR_FAILED(result) && named && *named)
    return Error{"headset",
                 std::string("the OpenXR runtime that XR_RUNTIME_JSON names, ") + named +
                     ", cannot be used (" + result_name(result) + ")",
                 "Name the manifest of one that is installed, or unset it"};
  if (result == XR_ERROR_RUNTIME_UNAVAILABLE || result == XR_ERROR_FILE_ACCESS_ERROR)
    return Error{"headset", "this machine has no OpenXR runtime", kInstall};
  if (result == XR_ERROR_FILE_CONTENTS_INVALID || result == XR_ERROR_INSTANCE_LOST ||
      result == XR_ERROR_INITIALIZATION_FAILED)
    return Error{"headset",
                 "the OpenXR runtime's manifest or library cannot be used (" + result_name(result) + ")",
                 "Look at ~/.config/openxr/1/active_runtime.json and /etc/xdg/openxr/1/active_runtime.json"};
  if (XR_FAILED(result)) return failed("xrEnumerateInstanceExtensionProperties", result);
  return all;
}

}  // namespace

Result<std::unique_ptr<Runtime>> Runtime::find() {
  quiet_loader();
  const auto offered = extensions();
  if (!offered) return offered.error();
  std::unique_ptr<Runtime> runtime(new Runtime());
  std::vector<const char*> wanted;
  runtime->egl_ = has(offered.value(), XR_MNDX_EGL_ENABLE_EXTENSION_NAME);
  runtime->glx_ = has(offered.value(), XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
  if (!runtime->glx_)
    return Error{"headset", "the OpenXR runtime takes no pictures from OpenGL (XR_KHR_opengl_enable)",
                 "Use another runtime: Monado, WiVRn and SteamVR do"};
  wanted.push_back(XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
  if (runtime->egl_) wanted.push_back(XR_MNDX_EGL_ENABLE_EXTENSION_NAME);
  const bool times = has(offered.value(), XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
  if (times) wanted.push_back(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);

  auto info = typed<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
  put(info.applicationInfo.applicationName, "slosh");
  info.applicationInfo.applicationVersion = 1;
  put(info.applicationInfo.engineName, "slosh");
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);  // what every runtime has
  info.enabledExtensionCount = static_cast<std::uint32_t>(wanted.size());
  info.enabledExtensionNames = wanted.data();
  XrResult result = xrCreateInstance(&info, &runtime->instance_);
  if (result == XR_ERROR_RUNTIME_UNAVAILABLE || result == XR_ERROR_RUNTIME_FAILURE)
    return Error{"headset", "the OpenXR runtime does not answer (" + result_name(result) + ")",
                 "Start it: monado-service, WiVRn's server, or SteamVR"};
  if (XR_FAILED(result)) return failed("xrCreateInstance", result);

  auto properties = typed<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
  if (XR_SUCCEEDED(xrGetInstanceProperties(runtime->instance_, &properties)))
    runtime->description_ = text_of(properties.runtimeName);
  auto wish = typed<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
  wish.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  result = xrGetSystem(runtime->instance_, &wish, &runtime->system_);
  if (result == XR_ERROR_FORM_FACTOR_UNAVAILABLE || result == XR_ERROR_FORM_FACTOR_UNSUPPORTED)
    return Error{"headset", "the runtime (" + runtime->description_ + ") has no headset",
                 "Plug it in, wake it up, and try again"};
  if (XR_FAILED(result)) return failed("xrGetSystem", result);
  auto system = typed<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
  if (XR_SUCCEEDED(xrGetSystemProperties(runtime->instance_, runtime->system_, &system)))
    runtime->description_ = text_of(system.systemName) + ", " + runtime->description_;
  if (times) {
    runtime->to_time_ =
        function_of<PFN_xrConvertTimespecTimeToTimeKHR>(runtime->instance_, "xrConvertTimespecTimeToTimeKHR");
  }
  return runtime;
}

Runtime::~Runtime() {
  if (instance_ != XR_NULL_HANDLE) xrDestroyInstance(instance_);
}

XrTime Runtime::now() const {
  timespec now{};
  XrTime time = 0;
  if (!to_time_ || clock_gettime(CLOCK_MONOTONIC, &now) != 0) return 0;
  return XR_SUCCEEDED(to_time_(instance_, &now, &time)) ? time : 0;
}

}  // namespace slosh::xr
