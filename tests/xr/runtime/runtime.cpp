#include "tests/xr/runtime/runtime.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <iterator>
#include <sstream>
#include <thread>

namespace slosh::xr_test {

State& the() {
  static State state;
  return state;
}

std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

double session_seconds(XrTime time) {
  return 1e-9 * static_cast<double>(time - the().began_ns);
}

XrResult wrong(const char* what, XrResult result) {
  the().log.say("WRONG %s", what);
  return result;
}

bool refuse(const char* call) {
  State& s = the();
  int& left = s.failures[call];
  if (left <= 0) return false;
  --left;
  s.log.say("refused %s", call);
  return true;
}

namespace {

constexpr const char* kStates[] = {"unknown", "idle",     "ready",        "synchronized", "visible",
                                   "focused", "stopping", "loss_pending", "exiting"};

XrSessionState state_named(const std::string& name) {
  for (std::size_t i = 0; i < std::size(kStates); ++i) {
    if (name == kStates[i]) return static_cast<XrSessionState>(i);
  }
  return XR_SESSION_STATE_UNKNOWN;
}

void happen(const std::string& what) {
  State& s = the();
  std::istringstream words(what);
  std::string verb;
  std::string name;
  int times = 1;
  words >> verb >> name >> times;
  if (verb == "state") change_state(state_named(name));
  if (verb == "fail") s.failures[name] = times;
  if (verb == "lose") s.failures["session"] = 1;
}

XrResult enumerate_extensions(const char*, std::uint32_t room, std::uint32_t* count,
                              XrExtensionProperties* out) {
  std::vector<const char*> names{XR_KHR_OPENGL_ENABLE_EXTENSION_NAME,
                                 XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME};
  if (Script::read().egl) names.push_back(XR_MNDX_EGL_ENABLE_EXTENSION_NAME);
  *count = static_cast<std::uint32_t>(names.size());
  for (std::uint32_t i = 0; i < *count && room >= *count; ++i) {
    std::strncpy(out[i].extensionName, names[i], XR_MAX_EXTENSION_NAME_SIZE - 1);
    out[i].extensionVersion = 1;
  }
  return XR_SUCCESS;
}

XrResult create_instance(const XrInstanceCreateInfo* info, XrInstance* instance) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  s.script = Script::read();
  {
    // What was to happen has happened to an instance before this one.
    std::ifstream before(s.script.folder / "log.txt");
    for (std::string line; std::getline(before, line);) {
      if (line == "instance gone") s.script.happenings.clear();
    }
  }
  s.log.open(s.script.folder / "log.txt");
  s.instance = ++s.last_handle;
  s.asked_needs = false;
  s.log.say("instance of %s", info->applicationInfo.applicationName);
  *instance = handle_of<XrInstance>(s.instance);
  return XR_SUCCESS;
}

XrResult destroy_instance(XrInstance) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (s.session != 0) wrong("an instance destroyed before its session", XR_SUCCESS);
  s.log.say("instance gone");
  s.instance = 0;
  return XR_SUCCESS;
}

XrResult instance_properties(XrInstance, XrInstanceProperties* properties) {
  // A name that fills the room has no end: what a program may not count on.
  const std::string& name = the().script.name;
  std::memcpy(properties->runtimeName, name.c_str(),
              std::min<std::size_t>(name.size() + 1, XR_MAX_RUNTIME_NAME_SIZE));
  properties->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
  return XR_SUCCESS;
}

XrResult get_system(XrInstance, const XrSystemGetInfo*, XrSystemId* system) {
  *system = 1;
  return the().script.headset ? XR_SUCCESS : XR_ERROR_FORM_FACTOR_UNAVAILABLE;
}

XrResult system_properties(XrInstance, XrSystemId, XrSystemProperties* properties) {
  std::strncpy(properties->systemName, "Test headset", XR_MAX_SYSTEM_NAME_SIZE - 1);
  return XR_SUCCESS;
}

XrResult blend_modes(XrInstance, XrSystemId, XrViewConfigurationType, std::uint32_t room,
                     std::uint32_t* count, XrEnvironmentBlendMode* out) {
  *count = 1;
  if (room >= 1) out[0] = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  return XR_SUCCESS;
}

XrResult view_sizes(XrInstance, XrSystemId, XrViewConfigurationType, std::uint32_t room, std::uint32_t* count,
                    XrViewConfigurationView* out) {
  *count = 2;
  for (std::uint32_t i = 0; i < 2 && room >= 2; ++i) {
    out[i].recommendedImageRectWidth = static_cast<std::uint32_t>(the().script.width);
    out[i].recommendedImageRectHeight = static_cast<std::uint32_t>(the().script.height);
    out[i].maxImageRectWidth = out[i].maxImageRectHeight = 4096;
    out[i].recommendedSwapchainSampleCount = out[i].maxSwapchainSampleCount = 1;
  }
  return XR_SUCCESS;
}

XrResult opengl_needs(XrInstance, XrSystemId, XrGraphicsRequirementsOpenGLKHR* needs) {
  the().asked_needs = true;
  needs->minApiVersionSupported = XR_MAKE_VERSION(4, 0, 0);
  needs->maxApiVersionSupported = XR_MAKE_VERSION(4, 6, 0);
  return XR_SUCCESS;
}

XrResult to_time(XrInstance, const timespec* when, XrTime* time) {
  *time = when->tv_sec * std::int64_t{1'000'000'000} + when->tv_nsec;
  return XR_SUCCESS;
}

XrResult create_session(XrInstance, const XrSessionCreateInfo* info, XrSession* session) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (refuse("xrCreateSession")) return XR_ERROR_RUNTIME_FAILURE;
  if (!s.asked_needs)
    return wrong("xrCreateSession before its needs were asked", XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING);
  if (s.session != 0) return wrong("a second session", XR_ERROR_LIMIT_REACHED);
  const auto* binding = static_cast<const XrBaseInStructure*>(info->next);
  if (!binding) return wrong("a session without a graphics binding", XR_ERROR_GRAPHICS_DEVICE_INVALID);
  const bool egl = binding->type == XR_TYPE_GRAPHICS_BINDING_EGL_MNDX;
  if (egl) {
    const auto* mine = reinterpret_cast<const XrGraphicsBindingEGLMNDX*>(binding);
    if (!mine->getProcAddress || !mine->display || !mine->context)
      return wrong("an EGL binding with something missing", XR_ERROR_GRAPHICS_DEVICE_INVALID);
  }
  s.session = ++s.last_handle;
  s.running = s.waited = s.begun = s.attached = false;
  s.polls_to_ready = -1;
  s.failures.clear();
  s.events.clear();
  s.log.say("session by %s", egl ? "EGL" : "GLX");
  *session = handle_of<XrSession>(s.session);
  s.state = XR_SESSION_STATE_UNKNOWN;
  change_state(XR_SESSION_STATE_IDLE);
  change_state(XR_SESSION_STATE_READY);
  return XR_SUCCESS;
}

XrResult destroy_session(XrSession) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (!s.chains.empty()) wrong("a session destroyed before its swapchains", XR_SUCCESS);
  s.spaces.clear();
  s.session = 0;
  s.lost = false;
  s.log.say("session gone");
  return XR_SUCCESS;
}

XrResult reference_spaces(XrSession, std::uint32_t room, std::uint32_t* count, XrReferenceSpaceType* out) {
  const bool stage = the().script.stage;
  *count = stage ? 3 : 2;
  if (room >= *count) {
    out[0] = XR_REFERENCE_SPACE_TYPE_VIEW;
    out[1] = XR_REFERENCE_SPACE_TYPE_LOCAL;
    if (stage) out[2] = XR_REFERENCE_SPACE_TYPE_STAGE;
  }
  return XR_SUCCESS;
}

XrResult poll_event(XrInstance, XrEventDataBuffer* event) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (s.polls_to_ready > 0 && --s.polls_to_ready == 0) change_state(XR_SESSION_STATE_READY);
  if (s.events.empty()) return XR_EVENT_UNAVAILABLE;
  *event = s.events.front();
  s.events.pop_front();
  return XR_SUCCESS;
}

XrResult begin_session(XrSession, const XrSessionBeginInfo*) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (s.state != XR_SESSION_STATE_READY)
    return wrong("xrBeginSession before READY", XR_ERROR_SESSION_NOT_READY);
  s.running = true;
  s.began_ns = s.next_ns = now_ns();
  s.log.say("session begun");
  change_state(XR_SESSION_STATE_SYNCHRONIZED);
  change_state(XR_SESSION_STATE_VISIBLE);
  change_state(XR_SESSION_STATE_FOCUSED);
  return XR_SUCCESS;
}

XrResult end_session(XrSession) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (s.state != XR_SESSION_STATE_STOPPING)
    return wrong("xrEndSession before STOPPING", XR_ERROR_SESSION_NOT_STOPPING);
  s.running = false;
  s.log.say("session ended");
  change_state(XR_SESSION_STATE_IDLE);
  s.polls_to_ready = 8;  // the headset is put on again
  return XR_SUCCESS;
}

XrResult wait_frame(XrSession, const XrFrameWaitInfo*, XrFrameState* frame) {
  State& s = the();
  std::int64_t until = 0;
  {
    const std::lock_guard lock(s.mutex);
    if (!s.running) return wrong("xrWaitFrame in a session that does not run", XR_ERROR_SESSION_NOT_RUNNING);
    if (s.waited) wrong("xrWaitFrame twice without xrBeginFrame", XR_SUCCESS);
    ++s.frame;
    const auto [first, last] = s.script.happenings.equal_range(s.frame);
    for (auto at = first; at != last; ++at) {
      if (!at->second.done) happen(at->second.what);
      at->second.done = true;
    }
    if (refuse("session")) s.lost = true;
    if (s.lost) return XR_ERROR_SESSION_LOST;
    if (refuse("xrWaitFrame")) return XR_ERROR_RUNTIME_FAILURE;
    const auto period = static_cast<std::int64_t>(1e9 / s.script.rate);
    s.next_ns = std::max(s.next_ns + period, now_ns());
    until = s.next_ns;
    s.waited = true;
    s.promised = until + period;
    frame->predictedDisplayTime = s.promised;
    frame->predictedDisplayPeriod = period;
    frame->shouldRender = s.state == XR_SESSION_STATE_VISIBLE || s.state == XR_SESSION_STATE_FOCUSED;
  }
  std::this_thread::sleep_until(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(until)));
  return XR_SUCCESS;
}

XrResult begin_frame(XrSession, const XrFrameBeginInfo*) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (!s.waited) return wrong("xrBeginFrame without xrWaitFrame", XR_ERROR_CALL_ORDER_INVALID);
  if (s.begun) wrong("xrBeginFrame twice without xrEndFrame", XR_SUCCESS);
  s.waited = false;
  s.begun = true;
  return XR_SUCCESS;
}

XrResult locate_views(XrSession, const XrViewLocateInfo* info, XrViewState* state, std::uint32_t room,
                      std::uint32_t* count, XrView* views) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (info->displayTime != s.promised) wrong("views of another time than the frame's", XR_SUCCESS);
  *count = 2;
  state->viewStateFlags = XR_VIEW_STATE_POSITION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_VALID_BIT;
  for (std::uint32_t i = 0; i < 2 && room >= 2; ++i) {
    const double side = i == 0 ? -0.5 : 0.5;
    // Looking down a little, at what lies on a table.
    views[i].pose.orientation = {-0.2588190f, 0.0f, 0.0f, 0.9659258f};
    views[i].pose.position = {static_cast<float>(s.script.head.x + side * s.script.ipd),
                              static_cast<float>(s.script.head.y), static_cast<float>(s.script.head.z)};
    // As headsets have it: wider to the outside.
    views[i].fov = i == 0 ? XrFovf{-0.75f, 0.65f, 0.7f, -0.7f} : XrFovf{-0.65f, 0.75f, 0.7f, -0.7f};
  }
  return XR_SUCCESS;
}

PFN_xrVoidFunction function_named(const std::string& name);

XrResult get_proc(XrInstance, const char* name, PFN_xrVoidFunction* function) {
  *function = function_named(name);
  return *function ? XR_SUCCESS : XR_ERROR_FUNCTION_UNSUPPORTED;
}

PFN_xrVoidFunction function_named(const std::string& name) {
#define SLOSH_IS(text, function) \
  if (name == text) return reinterpret_cast<PFN_xrVoidFunction>(function)
  SLOSH_IS("xrGetInstanceProcAddr", get_proc);
  SLOSH_IS("xrEnumerateInstanceExtensionProperties", enumerate_extensions);
  SLOSH_IS("xrCreateInstance", create_instance);
  SLOSH_IS("xrDestroyInstance", destroy_instance);
  SLOSH_IS("xrGetInstanceProperties", instance_properties);
  SLOSH_IS("xrGetSystem", get_system);
  SLOSH_IS("xrGetSystemProperties", system_properties);
  SLOSH_IS("xrEnumerateEnvironmentBlendModes", blend_modes);
  SLOSH_IS("xrEnumerateViewConfigurationViews", view_sizes);
  SLOSH_IS("xrGetOpenGLGraphicsRequirementsKHR", opengl_needs);
  SLOSH_IS("xrConvertTimespecTimeToTimeKHR", to_time);
  SLOSH_IS("xrCreateSession", create_session);
  SLOSH_IS("xrDestroySession", destroy_session);
  SLOSH_IS("xrEnumerateReferenceSpaces", reference_spaces);
  SLOSH_IS("xrPollEvent", poll_event);
  SLOSH_IS("xrBeginSession", begin_session);
  SLOSH_IS("xrEndSession", end_session);
  SLOSH_IS("xrWaitFrame", wait_frame);
  SLOSH_IS("xrBeginFrame", begin_frame);
  SLOSH_IS("xrLocateViews", locate_views);
#undef SLOSH_IS
  if (PFN_xrVoidFunction found = input_function(name)) return found;
  return picture_function(name);
}

}  // namespace

void change_state(XrSessionState state) {
  State& s = the();
  s.state = state;
  auto buffer = typed<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
  auto& event = reinterpret_cast<XrEventDataSessionStateChanged&>(buffer);
  event.type = XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED;
  event.session = handle_of<XrSession>(s.session);
  event.state = state;
  event.time = now_ns();
  s.events.push_back(buffer);
  s.log.say("state %s", kStates[static_cast<std::size_t>(state)]);
}

// What a loader asks a runtime for (its interface, version 1): Debian's package has no header for it.
struct LoaderInfo {
  int type;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t least;
  std::uint32_t most;
  XrVersion least_api;
  XrVersion most_api;
};
struct RuntimeRequest {
  int type;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t interface_version;
  XrVersion api_version;
  PFN_xrGetInstanceProcAddr get_proc;
};

}  // namespace slosh::xr_test

extern "C" __attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const slosh::xr_test::LoaderInfo* loader, slosh::xr_test::RuntimeRequest* runtime) {
  if (!loader || !runtime || loader->least > 1 || loader->most < 1) return XR_ERROR_INITIALIZATION_FAILED;
  runtime->interface_version = 1;
  runtime->api_version = XR_CURRENT_API_VERSION;
  runtime->get_proc = reinterpret_cast<PFN_xrGetInstanceProcAddr>(slosh::xr_test::get_proc);
  return XR_SUCCESS;
}
