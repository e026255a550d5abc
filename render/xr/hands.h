// Both controllers: actions, bindings of the common kinds, poses and vibration.
#pragma once

#include <array>
#include <mutex>

#include "render/headset_hands.h"
#include "render/xr/runtime.h"

namespace slosh::xr {

/// Outlives sessions: what reads it sees nothing tracked between two. Its lock is never held while a picture
/// is waited for, so that hands go on at their own pace beside a slow picture.
class Hands final : public HeadsetHands {
 public:
  HandReading read(HandSide side) override;
  void vibrate(HandSide side, double strength, double seconds) override;

  /// A session begins, and poses are told in `room`. `runtime` and both must live until detach(). Errors:
  /// actions that the runtime refuses.
  Result<bool> attach(const Runtime& runtime, XrSession session, XrSpace room);
  void detach();
  /// The time of the picture that was begun last, for a runtime that does not say what time it is.
  void note_time(XrTime predicted);

 private:
  Result<bool> make_actions(XrInstance instance);
  Result<bool> make_spaces();
  void sync();
  /// Whether a call went well; notes a session that is gone for good.
  bool answers(XrResult result);
  float value(XrAction action, int side) const;
  bool pressed(XrAction action, int side) const;

  std::mutex mutex_;
  const Runtime* runtime_ = nullptr;
  XrSession session_ = XR_NULL_HANDLE;
  XrSpace room_ = XR_NULL_HANDLE;
  XrActionSet set_ = XR_NULL_HANDLE;
  XrAction pose_ = XR_NULL_HANDLE;
  XrAction squeeze_ = XR_NULL_HANDLE;
  XrAction trigger_ = XR_NULL_HANDLE;
  XrAction primary_ = XR_NULL_HANDLE;
  XrAction secondary_ = XR_NULL_HANDLE;
  XrAction shake_ = XR_NULL_HANDLE;
  std::array<XrPath, 2> sides_{};
  std::array<XrSpace, 2> spaces_{};
  XrTime predicted_ = 0;
  std::int64_t synced_ns_ = 0;
  bool focused_ = false;
  bool gone_ =
      false;  // the runtime said so: it is not asked a thousand times a second until the next attach()
};

}  // namespace slosh::xr
