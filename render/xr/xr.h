// OpenXR's headers and the few things that all of this folder does with them.
#pragma once

#include <epoxy/egl.h>
#include <time.h>

#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_EGL
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <cstring>
#include <string>

#include "net/text/clean.h"
#include "sim/math/pose.h"
#include "sim/math/result.h"

namespace slosh::xr {

/// One of OpenXR's structures, empty but for its type.
template <class Structure>
Structure typed(XrStructureType type) {
  Structure structure{};
  structure.type = type;
  return structure;
}

/// "XR_ERROR_RUNTIME_FAILURE", or its number where this header does not know it.
std::string result_name(XrResult result);

/// "headset: <call> failed: XR_ERROR_…", with what helps as a rule.
Error failed(const char* call, XrResult result);

inline Pose to_pose(const XrPosef& p) {
  return {{p.position.x, p.position.y, p.position.z},
          glm::normalize(glm::dquat(p.orientation.w, p.orientation.x, p.orientation.y, p.orientation.z))};
}
inline XrPosef from_pose(const Pose& p) {
  const glm::vec3 at(p.position);
  const glm::quat q(p.orientation);
  return {{q.x, q.y, q.z, q.w}, {at.x, at.y, at.z}};
}
inline XrPosef no_move() {
  return from_pose({});
}

/// Copies `text` into one of OpenXR's arrays of characters, cut where it is too long.
template <std::size_t N>
void put(char (&array)[N], const std::string& text) {
  std::strncpy(array, text.c_str(), N - 1);
  array[N - 1] = '\0';
}

/// What a runtime wrote into one of OpenXR's arrays, fit to be shown, whether or not it ended it.
template <std::size_t N>
std::string text_of(const char (&array)[N]) {
  return clean_text({array, strnlen(array, N)}, N);
}

/// A function of an extension; null where the runtime has none by that name.
template <class Function>
Function function_of(XrInstance instance, const char* name) {
  PFN_xrVoidFunction found = nullptr;
  if (XR_FAILED(xrGetInstanceProcAddr(instance, name, &found))) return nullptr;
  return reinterpret_cast<Function>(found);
}

}  // namespace slosh::xr
