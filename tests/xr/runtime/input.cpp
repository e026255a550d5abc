// Actions, spaces and vibration.
#include <cstring>

#include "tests/xr/runtime/runtime.h"

namespace slosh::xr_test {
namespace {

XrResult string_to_path(XrInstance, const char* text, XrPath* path) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  for (std::size_t i = 1; i < s.paths.size(); ++i) {
    if (s.paths[i] == text) {
      *path = i;
      return XR_SUCCESS;
    }
  }
  s.paths.emplace_back(text);
  *path = s.paths.size() - 1;
  return XR_SUCCESS;
}

XrResult create_action_set(XrInstance, const XrActionSetCreateInfo*, XrActionSet* set) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  *set = handle_of<XrActionSet>(++s.last_handle);
  return XR_SUCCESS;
}

XrResult destroy_action_set(XrActionSet) {
  the().attached = false;
  return XR_SUCCESS;
}

XrResult create_action(XrActionSet, const XrActionCreateInfo* info, XrAction* action) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  *action = handle_of<XrAction>(++s.last_handle);
  s.actions[s.last_handle] = info->actionName;
  return XR_SUCCESS;
}

XrResult suggest(XrInstance, const XrInteractionProfileSuggestedBinding* suggested) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  s.log.say("bindings %s %u", s.paths[suggested->interactionProfile].c_str(),
            suggested->countSuggestedBindings);
  return XR_SUCCESS;
}

XrResult attach(XrSession, const XrSessionActionSetsAttachInfo*) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (s.attached) return wrong("action sets attached twice", XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
  s.attached = true;
  return XR_SUCCESS;
}

XrResult sync(XrSession session, const XrActionsSyncInfo*) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  if (number_of(session) != s.session)
    return wrong("xrSyncActions on a session that is gone", XR_ERROR_HANDLE_INVALID);
  if (!s.attached) return wrong("xrSyncActions before attaching", XR_ERROR_ACTIONSET_NOT_ATTACHED);
  if (s.lost) {
    s.log.say("hands asked for of a session that is lost");
    return XR_ERROR_SESSION_LOST;
  }
  return s.state == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}

int side_of(XrPath path) {
  return the().paths[path].find("right") != std::string::npos ? 1 : 0;
}

XrResult get_float(XrSession, const XrActionStateGetInfo* info, XrActionStateFloat* state) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  const ScriptedHand& hand = s.script.hands[side_of(info->subactionPath)];
  const double at = session_seconds(now_ns());
  const bool held = at >= hand.squeeze_from && at < hand.squeeze_until;
  state->isActive = hand.there && s.state == XR_SESSION_STATE_FOCUSED;
  state->currentState = s.actions[number_of(info->action)] == "hold" && held ? 1.0f : 0.0f;
  return XR_SUCCESS;
}

XrResult get_boolean(XrSession, const XrActionStateGetInfo*, XrActionStateBoolean* state) {
  state->isActive = XR_TRUE;
  state->currentState = XR_FALSE;
  return XR_SUCCESS;
}

XrResult create_reference_space(XrSession, const XrReferenceSpaceCreateInfo* info, XrSpace* space) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  *space = handle_of<XrSpace>(++s.last_handle);
  const bool head = info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_VIEW;
  s.spaces[s.last_handle] = head ? SpaceKind::kHead : SpaceKind::kRoom;
  return XR_SUCCESS;
}

XrResult create_action_space(XrSession, const XrActionSpaceCreateInfo* info, XrSpace* space) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  *space = handle_of<XrSpace>(++s.last_handle);
  s.spaces[s.last_handle] = side_of(info->subactionPath) == 1 ? SpaceKind::kRight : SpaceKind::kLeft;
  return XR_SUCCESS;
}

XrResult destroy_space(XrSpace space) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  s.spaces.erase(number_of(space));
  return XR_SUCCESS;
}

XrResult locate_space(XrSpace space, XrSpace base, XrTime time, XrSpaceLocation* location) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  const auto found = s.spaces.find(number_of(space));
  if (found == s.spaces.end() || !s.spaces.contains(number_of(base)))
    return wrong("a space that is gone", XR_ERROR_HANDLE_INVALID);
  location->locationFlags = 0;
  const int side = found->second == SpaceKind::kRight ? 1 : 0;
  const ScriptedHand& hand = s.script.hands[side];
  if (!hand.there || s.state != XR_SESSION_STATE_FOCUSED) return XR_SUCCESS;
  const Pose pose = hand_pose(hand, session_seconds(time));
  const Twist twist = hand_twist(hand, session_seconds(time));
  location->locationFlags = XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT |
                            XR_SPACE_LOCATION_POSITION_TRACKED_BIT |
                            XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;
  const glm::vec3 at(pose.position);
  location->pose = {{0.0f, 0.0f, 0.0f, 1.0f}, {at.x, at.y, at.z}};
  if (auto* velocity = static_cast<XrSpaceVelocity*>(location->next)) {
    const glm::vec3 v(twist.linear);
    velocity->velocityFlags = XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT;
    velocity->linearVelocity = {v.x, v.y, v.z};
    velocity->angularVelocity = {};
  }
  return XR_SUCCESS;
}

XrResult shake(XrSession, const XrHapticActionInfo* info, const XrHapticBaseHeader* what) {
  State& s = the();
  const std::lock_guard lock(s.mutex);
  const auto* vibration = reinterpret_cast<const XrHapticVibration*>(what);
  s.log.say("vibrate %s %.3f %.0f ms", side_of(info->subactionPath) == 1 ? "right" : "left",
            static_cast<double>(vibration->amplitude), 1e-6 * static_cast<double>(vibration->duration));
  return XR_SUCCESS;
}

XrResult stop_shaking(XrSession, const XrHapticActionInfo*) {
  return XR_SUCCESS;
}

}  // namespace

PFN_xrVoidFunction input_function(const std::string& name) {
#define SLOSH_IS(text, function) \
  if (name == text) return reinterpret_cast<PFN_xrVoidFunction>(function)
  SLOSH_IS("xrStringToPath", string_to_path);
  SLOSH_IS("xrCreateActionSet", create_action_set);
  SLOSH_IS("xrDestroyActionSet", destroy_action_set);
  SLOSH_IS("xrCreateAction", create_action);
  SLOSH_IS("xrSuggestInteractionProfileBindings", suggest);
  SLOSH_IS("xrAttachSessionActionSets", attach);
  SLOSH_IS("xrSyncActions", sync);
  SLOSH_IS("xrGetActionStateFloat", get_float);
  SLOSH_IS("xrGetActionStateBoolean", get_boolean);
  SLOSH_IS("xrCreateReferenceSpace", create_reference_space);
  SLOSH_IS("xrCreateActionSpace", create_action_space);
  SLOSH_IS("xrDestroySpace", destroy_space);
  SLOSH_IS("xrLocateSpace", locate_space);
  SLOSH_IS("xrApplyHapticFeedback", shake);
  SLOSH_IS("xrStopHapticFeedback", stop_shaking);
#undef SLOSH_IS
  return nullptr;
}

}  // namespace slosh::xr_test
