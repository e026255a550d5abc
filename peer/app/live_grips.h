// How stiff the grips are held, between the world's switches, the device loop and the sliders.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "net/wire/control_messages.h"
#include "peer/haptics/servo.h"
#include "peer/view/live_panel.h"
#include "scenes/scene.h"

namespace slosh {

/// What a slider asks the world for; nothing where it asks somebody else.
inline std::optional<wire::Parameter> parameter_of(LiveWish::Kind kind) {
  switch (kind) {
    case LiveWish::Kind::kViscosity:
      return wire::Parameter::kFluidViscosity;
    case LiveWish::Kind::kGravityScale:
      return wire::Parameter::kGravityScale;
    case LiveWish::Kind::kGripStiffness:
      return wire::Parameter::kGripStiffness;
    case LiveWish::Kind::kPace:
    case LiveWish::Kind::kFilter:
      break;
  }
  return std::nullopt;
}

/// `stiffness`: the world's, one a grip, or none.
inline std::vector<LiveGrip> live_grips(const Scene& scene, const std::vector<double>& stiffness,
                                        const Servo& servo) {
  std::vector<LiveGrip> grips;
  for (std::size_t i = 0; i < std::min(stiffness.size(), scene.grips.size()); ++i) {
    LiveGrip grip{stiffness[i], scene.grips[i].stiffness, 0.0};
    const Device* const device = servo.holds(i) ? servo.device(i) : nullptr;
    if (device != nullptr && device->gives_way()) grip.of_device = device->limits().max_stiffness;
    grips.push_back(grip);
  }
  return grips;
}

inline void follow_stiffness(const std::vector<double>& stiffness, Servo& servo) {
  for (std::size_t i = 0; i < std::min(stiffness.size(), servo.devices()); ++i)
    servo.set_stiffness(i, stiffness[i]);
}

}  // namespace slosh
