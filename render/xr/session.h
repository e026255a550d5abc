// One session: its states, spaces, swapchains and the loop of frames.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "render/headset.h"
#include "render/xr/hands.h"
#include "render/xr/swapchain.h"

namespace slosh::xr {

class Session {
 public:
  /// All must outlive it. Errors: what the runtime refuses.
  static Result<std::unique_ptr<Session>> begin(const Runtime& runtime, const Context& context, Hands& hands,
                                                const HeadsetOptions& options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  HeadsetState poll();
  bool frame(const std::function<HeadsetPlaces(const Pose& head)>& places,
             const std::function<void(const HeadsetPictures&)>& draw);
  const std::optional<Pose>& head() const { return head_; }
  bool floor_known() const { return floor_known_; }
  double period() const { return period_; }
  std::string take_problem() { return std::exchange(problem_, {}); }

 private:
  Session(const Runtime& runtime, Hands& hands, const HeadsetOptions& options)
      : runtime_(runtime), hands_(hands), options_(options) {}
  Result<bool> make_room();
  Result<bool> make_swapchains();
  void take_event(const XrEventDataBuffer& event);
  void enter(XrSessionState state);
  bool locate_eyes(XrTime time, std::array<XrView, 2>& eyes);
  /// The runtime refused `call`; says so, the first time of a row.
  bool refused(const char* call, XrResult result);
  XrResult end_frame(XrTime time, std::span<const XrCompositionLayerBaseHeader* const> layers) const;
  bool acquire(const HeadsetPanel& panel, HeadsetPictures& pictures);
  bool release();

  const Runtime& runtime_;
  Hands& hands_;
  HeadsetOptions options_;
  XrSession handle_ = XR_NULL_HANDLE;
  XrSpace room_ = XR_NULL_HANDLE;
  XrEnvironmentBlendMode blend_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  std::array<Swapchain, 2> eyes_;
  Swapchain panel_;
  bool panel_drawn_ = false;  // once at least: there is something to show
  bool running_ = false;      // begun, and not ended
  HeadsetState state_ = HeadsetState::kAway;
  bool floor_known_ = false;
  std::optional<Pose> head_;
  double period_ = 0.0;
  int refused_in_a_row_ = 0;
  std::string problem_;
};

}  // namespace slosh::xr
