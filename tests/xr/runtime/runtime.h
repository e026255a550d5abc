// An OpenXR runtime as small as this program's use of it, which notes what it is asked and whether the order
// is right. One instance and one session at a time.
#pragma once

#include <epoxy/egl.h>
#include <time.h>

#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_EGL
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tests/xr/runtime/script.h"

namespace slosh::xr_test {

template <class Structure>
Structure typed(XrStructureType type) {
  Structure structure{};
  structure.type = type;
  return structure;
}

/// A handle is a number that never comes again.
template <class Handle>
Handle handle_of(std::uint64_t number) {
  return reinterpret_cast<Handle>(number);
}
template <class Handle>
std::uint64_t number_of(Handle handle) {
  return reinterpret_cast<std::uint64_t>(handle);
}

struct Chain {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> textures;
  std::size_t next = 0;
  int acquired = -1;
  bool waited = false;
  int released = -1;  // what a layer shows
};

enum class SpaceKind { kRoom, kHead, kLeft, kRight };

struct State {
  std::mutex mutex;
  Script script;
  Log log;
  std::uint64_t last_handle = 100;
  std::uint64_t instance = 0;
  bool asked_needs = false;
  // The session.
  std::uint64_t session = 0;
  bool running = false;
  bool lost = false;
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;
  std::int64_t began_ns = 0;
  std::uint64_t frame = 0;  // of xrWaitFrame, over all sessions
  bool waited = false;
  bool begun = false;
  XrTime promised = 0;
  std::int64_t next_ns = 0;
  int polls_to_ready = -1;
  std::deque<XrEventDataBuffer> events;
  std::map<std::string, int> failures;  // calls still to be refused, by name
  std::map<std::uint64_t, Chain> chains;
  std::map<std::uint64_t, SpaceKind> spaces;
  // Input.
  std::vector<std::string> paths{""};
  std::map<std::uint64_t, std::string> actions;
  bool attached = false;
};

State& the();

std::int64_t now_ns();
/// s since the session began, at `time`.
double session_seconds(XrTime time);
void change_state(XrSessionState state);
/// Notes that the program did what the standard forbids, and returns the error for it.
XrResult wrong(const char* what, XrResult result);
/// Whether `call` is to be refused this time.
bool refuse(const char* call);

/// The functions of input.cpp and pictures.cpp by name; null for others.
PFN_xrVoidFunction input_function(const std::string& name);
PFN_xrVoidFunction picture_function(const std::string& name);

}  // namespace slosh::xr_test
