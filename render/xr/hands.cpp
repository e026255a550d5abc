#include "render/xr/hands.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace slosh::xr {
namespace {

/// Buttons are asked for this often; poses at each reading.
constexpr std::int64_t kSyncEvery = 4'000'000;  // ns

constexpr std::array<const char*, 2> kSides{"/user/hand/left", "/user/hand/right"};

std::int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// Where the actions are on one kind of controller; nullptr = not there. %s of either hand alike.
struct Profile {
  const char* name;
  const char* squeeze;
  const char* trigger;
  std::array<const char*, 2> primary;  ///< left, right
  std::array<const char*, 2> secondary;
};
constexpr Profile kProfiles[] = {
    {"/interaction_profiles/khr/simple_controller",
     "/input/select/click",
     nullptr,
     {nullptr, nullptr},
     {"/input/menu/click", "/input/menu/click"}},
    {"/interaction_profiles/oculus/touch_controller",
     "/input/squeeze/value",
     "/input/trigger/value",
     {"/input/x/click", "/input/a/click"},
     {"/input/y/click", "/input/b/click"}},
    {"/interaction_profiles/valve/index_controller",
     "/input/squeeze/value",
     "/input/trigger/value",
     {"/input/a/click", "/input/a/click"},
     {"/input/b/click", "/input/b/click"}},
    {"/interaction_profiles/htc/vive_controller",
     "/input/squeeze/click",
     "/input/trigger/value",
     {"/input/trackpad/click", "/input/trackpad/click"},
     {"/input/menu/click", "/input/menu/click"}},
    {"/interaction_profiles/microsoft/motion_controller",
     "/input/squeeze/click",
     "/input/trigger/value",
     {"/input/trackpad/click", "/input/trackpad/click"},
     {"/input/menu/click", "/input/menu/click"}},
};

XrPath path_of(XrInstance instance, const std::string& text) {
  XrPath path = XR_NULL_PATH;
  xrStringToPath(instance, text.c_str(), &path);
  return path;
}

}  // namespace

Result<bool> Hands::attach(const Runtime& runtime, XrSession session, XrSpace room) {
  const std::lock_guard lock(mutex_);
  runtime_ = &runtime;
  session_ = session;
  gone_ = false;
  room_ = room;
  Result<bool> made = make_actions(runtime.instance());
  if (made) made = make_spaces();
  if (!made) session_ = XR_NULL_HANDLE;
  return made;
}

void Hands::detach() {
  const std::lock_guard lock(mutex_);
  for (XrSpace& space : spaces_) {
    if (space != XR_NULL_HANDLE) xrDestroySpace(space);
    space = XR_NULL_HANDLE;
  }
  if (set_ != XR_NULL_HANDLE) xrDestroyActionSet(set_);
  set_ = XR_NULL_HANDLE;
  session_ = XR_NULL_HANDLE;
  runtime_ = nullptr;
  focused_ = false;
  predicted_ = 0;
}

void Hands::note_time(XrTime predicted) {
  const std::lock_guard lock(mutex_);
  predicted_ = predicted;
}

Result<bool> Hands::make_actions(XrInstance instance) {
  for (std::size_t i = 0; i < sides_.size(); ++i) sides_[i] = path_of(instance, kSides[i]);
  auto set = typed<XrActionSetCreateInfo>(XR_TYPE_ACTION_SET_CREATE_INFO);
  put(set.actionSetName, "hands");
  put(set.localizedActionSetName, "Hands");
  if (const XrResult result = xrCreateActionSet(instance, &set, &set_); XR_FAILED(result))
    return failed("xrCreateActionSet", result);
  struct Wanted {
    XrAction* action;
    const char* name;
    const char* shown;
    XrActionType type;
  };
  for (const Wanted& wanted :
       {Wanted{&pose_, "grip_pose", "Where the hand is", XR_ACTION_TYPE_POSE_INPUT},
        Wanted{&squeeze_, "hold", "Hold on", XR_ACTION_TYPE_FLOAT_INPUT},
        Wanted{&trigger_, "trigger", "Trigger", XR_ACTION_TYPE_FLOAT_INPUT},
        Wanted{&primary_, "primary", "First button", XR_ACTION_TYPE_BOOLEAN_INPUT},
        Wanted{&secondary_, "secondary", "Second button", XR_ACTION_TYPE_BOOLEAN_INPUT},
        Wanted{&shake_, "force_change", "Change of the force", XR_ACTION_TYPE_VIBRATION_OUTPUT}}) {
    auto info = typed<XrActionCreateInfo>(XR_TYPE_ACTION_CREATE_INFO);
    info.actionType = wanted.type;
    put(info.actionName, wanted.name);
    put(info.localizedActionName, wanted.shown);
    info.countSubactionPaths = static_cast<std::uint32_t>(sides_.size());
    info.subactionPaths = sides_.data();
    if (const XrResult result = xrCreateAction(set_, &info, wanted.action); XR_FAILED(result))
      return failed("xrCreateAction", result);
  }
  int taken = 0;
  XrResult refused = XR_SUCCESS;
  for (const Profile& profile : kProfiles) {
    std::vector<XrActionSuggestedBinding> bindings;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const auto bind = [&](XrAction action, const char* where) {
        if (where) bindings.push_back({action, path_of(instance, std::string(kSides[i]) + where)});
      };
      bind(pose_, "/input/grip/pose");
      bind(squeeze_, profile.squeeze);
      bind(trigger_, profile.trigger);
      bind(primary_, profile.primary[i]);
      bind(secondary_, profile.secondary[i]);
      bind(shake_, "/output/haptic");
    }
    auto suggested =
        typed<XrInteractionProfileSuggestedBinding>(XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
    suggested.interactionProfile = path_of(instance, profile.name);
    suggested.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
    suggested.suggestedBindings = bindings.data();
    const XrResult result = xrSuggestInteractionProfileBindings(instance, &suggested);
    if (XR_SUCCEEDED(result))
      ++taken;
    else
      refused = result;
  }
  if (taken == 0) return failed("xrSuggestInteractionProfileBindings", refused);
  auto attach = typed<XrSessionActionSetsAttachInfo>(XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
  attach.countActionSets = 1;
  attach.actionSets = &set_;
  if (const XrResult result = xrAttachSessionActionSets(session_, &attach); XR_FAILED(result))
    return failed("xrAttachSessionActionSets", result);
  return true;
}

Result<bool> Hands::make_spaces() {
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    auto info = typed<XrActionSpaceCreateInfo>(XR_TYPE_ACTION_SPACE_CREATE_INFO);
    info.action = pose_;
    info.subactionPath = sides_[i];
    info.poseInActionSpace = no_move();
    if (const XrResult result = xrCreateActionSpace(session_, &info, &spaces_[i]); XR_FAILED(result))
      return failed("xrCreateActionSpace", result);
  }
  return true;
}

bool Hands::answers(XrResult result) {
  if (result == XR_ERROR_SESSION_LOST || result == XR_ERROR_INSTANCE_LOST) gone_ = true;
  return XR_SUCCEEDED(result);
}

void Hands::sync() {
  const std::int64_t now_ns = steady_ns();
  if (now_ns - synced_ns_ < kSyncEvery) return;
  synced_ns_ = now_ns;
  const XrActiveActionSet active{set_, XR_NULL_PATH};
  auto info = typed<XrActionsSyncInfo>(XR_TYPE_ACTIONS_SYNC_INFO);
  info.countActiveActionSets = 1;
  info.activeActionSets = &active;
  const XrResult result = xrSyncActions(session_, &info);
  focused_ = answers(result) && result == XR_SUCCESS;  // XR_SESSION_NOT_FOCUSED is no failure either
}

float Hands::value(XrAction action, int side) const {
  auto info = typed<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
  info.action = action;
  info.subactionPath = sides_[static_cast<std::size_t>(side)];
  auto state = typed<XrActionStateFloat>(XR_TYPE_ACTION_STATE_FLOAT);
  const bool fine = XR_SUCCEEDED(xrGetActionStateFloat(session_, &info, &state)) && state.isActive;
  return fine && std::isfinite(state.currentState) ? state.currentState : 0.0f;
}

bool Hands::pressed(XrAction action, int side) const {
  auto info = typed<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
  info.action = action;
  info.subactionPath = sides_[static_cast<std::size_t>(side)];
  auto state = typed<XrActionStateBoolean>(XR_TYPE_ACTION_STATE_BOOLEAN);
  return XR_SUCCEEDED(xrGetActionStateBoolean(session_, &info, &state)) && state.isActive &&
         state.currentState;
}

HandReading Hands::read(HandSide hand) {
  const int side = hand == HandSide::kLeft ? 0 : 1;
  const std::lock_guard lock(mutex_);
  HandReading reading;
  if (session_ == XR_NULL_HANDLE || gone_) return reading;
  sync();
  if (!focused_) return reading;
  XrTime time = runtime_->now();
  if (time == 0) time = predicted_;
  if (time == 0) return reading;
  auto velocity = typed<XrSpaceVelocity>(XR_TYPE_SPACE_VELOCITY);
  auto location = typed<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
  location.next = &velocity;
  constexpr XrSpaceLocationFlags kPlace =
      XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  if (!answers(xrLocateSpace(spaces_[static_cast<std::size_t>(side)], room_, time, &location)) ||
      (location.locationFlags & kPlace) != kPlace) {
    return reading;
  }
  reading.tracked = true;
  reading.pose = to_pose(location.pose);
  const XrVector3f& v = velocity.linearVelocity;
  const XrVector3f& w = velocity.angularVelocity;
  constexpr XrSpaceVelocityFlags kBoth =
      XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT;
  reading.twist_known = (velocity.velocityFlags & kBoth) == kBoth;
  if (reading.twist_known) reading.twist = {{v.x, v.y, v.z}, {w.x, w.y, w.z}};
  reading.squeeze = value(squeeze_, side);
  reading.trigger = value(trigger_, side);
  reading.buttons =
      (reading.trigger > 0.5f ? kHandTrigger : 0u) | (pressed(primary_, side) ? kHandPrimary : 0u) |
      (pressed(secondary_, side) ? kHandSecondary : 0u) | (reading.squeeze > 0.5f ? kHandSqueeze : 0u);
  return reading;
}

void Hands::vibrate(HandSide hand, double strength, double seconds) {
  const std::lock_guard lock(mutex_);
  if (session_ == XR_NULL_HANDLE || gone_ || !focused_) return;
  auto info = typed<XrHapticActionInfo>(XR_TYPE_HAPTIC_ACTION_INFO);
  info.action = shake_;
  info.subactionPath = sides_[hand == HandSide::kLeft ? 0 : 1];
  if (!(strength > 0.0)) {
    xrStopHapticFeedback(session_, &info);
    return;
  }
  auto vibration = typed<XrHapticVibration>(XR_TYPE_HAPTIC_VIBRATION);
  vibration.amplitude = static_cast<float>(std::min(strength, 1.0));
  vibration.duration = static_cast<XrDuration>(1e9 * seconds);
  vibration.frequency = XR_FREQUENCY_UNSPECIFIED;
  xrApplyHapticFeedback(session_, &info, reinterpret_cast<const XrHapticBaseHeader*>(&vibration));
}

}  // namespace slosh::xr
