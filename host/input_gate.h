// From the poses that peers send to the inputs that a step takes: checked, ramped, in a fixed order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "net/channel.h"
#include "net/clock.h"
#include "net/engagement.h"
#include "scenes/scene.h"
#include "sim/math/coupling.h"
#include "sim/world.h"

namespace slosh {

/// Why a pose was not used.
enum class PoseFault : std::uint8_t {
  kNone,
  kNonFinite,     ///< a NaN or an infinity
  kNotARotation,  ///< the quaternion's length is off 1 by more than 1 %
  kOutOfRange,    ///< farther outside the domain than kHandleReach
  kTooFast,       ///< a twist, or a jump since the last good pose, above the limits below
};

constexpr double kHandleReach = 5.0;           ///< m beyond the scene's domain
constexpr double kHandleSpeed = 20.0;          ///< m/s
constexpr double kHandleAngularSpeed = 100.0;  ///< rad/s

/// Takes each device's newest message at a step's boundary, device 0 first. A pose that fails a check is not
/// used: the last good one stays, standing still. Owned by the host's thread.
class InputGate {
 public:
  explicit InputGate(const Scene& scene);

  /// The inputs for the step that follows `now`, one a grip. The result is valid until the next call.
  std::span<const HandleInput> take(Channel& channel, const BodySnapshot& now);

  /// Takes in one message; false (and the fault kept in last_fault()) when it is not used.
  bool accept(const PoseMessage& message);

  std::uint64_t rejected() const { return rejected_; }
  PoseFault last_fault() const { return last_fault_; }

 private:
  struct Hand {
    CouplingGains gains;
    Engagement engagement;
    PoseMessage good;
    bool has_good = false;
  };
  PoseFault check(const PoseMessage& message, const Hand& hand) const;

  glm::dvec3 reach_min_;
  glm::dvec3 reach_max_;
  std::vector<Hand> hands_;
  std::vector<HandleInput> inputs_;
  std::uint64_t rejected_ = 0;
  PoseFault last_fault_ = PoseFault::kNone;
};

}  // namespace slosh
