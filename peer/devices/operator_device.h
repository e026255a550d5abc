// A simulated operator: an arm that the force moves, tremor, and a person who sees and corrects 0.2 s late.
#pragma once

#include <array>
#include <string>

#include "peer/devices/operator_arm.h"
#include "peer/haptics/device.h"
#include "peer/haptics/pose_track.h"

namespace slosh {

struct OperatorSettings {
  ArmImpedance arm{1.5, 30.0, 800.0};    ///< kg, N·s/m, N/m
  ArmImpedance wrist{0.004, 0.06, 4.0};  ///< kg·m², N·m·s/rad, N·m/rad
  double tremor = 0.0;                   ///< m, amplitude of three tones from 8 to 12 Hz
  double delay = 0.2;                    ///< s from what happens to what is done about it, 0–0.5
  double correction = 2.0;               ///< 1/s: how fast what is seen to be off is made good; 0 = blind
};

/// "tight" or "loose", then any of mass=, damping=, stiffness= (of the arm), wrist= (N·m/rad), tremor=,
/// delay=, correction=, apart by commas; empty is "tight". Errors: another word, a number out of its range.
Result<OperatorSettings> parse_operator(const std::string& options);

/// Moves by simulated time along `track`, as far as the force lets it; where that stands (a pause, a silence)
/// the arm lives on, as a person's does, and what it is told meanwhile moves it. What it carries when it
/// engages it carries from then on, as who lifts a bucket does. Neither clock nor random numbers: the same
/// forces give the same motion bitwise.
class OperatorDevice final : public Device {
 public:
  OperatorDevice(PoseTrack track, const OperatorSettings& settings);

  DeviceReport read(const DeviceMoment& moment) noexcept override;
  void write(const Wrench& on_hand) noexcept override;
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  bool goes_with_world() const override { return true; }
  std::string kind() const override { return "operator"; }

 private:
  void begin(double time) noexcept;
  void live(double seconds) noexcept;
  void see() noexcept;
  void correct(double seconds) noexcept;

  /// What is off where it should be, as it was seen.
  struct Seen {
    double time = 0.0;
    glm::dvec3 place{0.0};
    glm::dvec3 turn{0.0};
  };
  static constexpr std::size_t kSeen = 1024;  // of one a millisecond at most: a second

  PoseTrack track_;
  OperatorSettings settings_;
  PoseTrack::Sample goal_;
  ArmState arm_;          // about where the hand is wanted
  ArmState wrist_;        // the same as a rotation vector
  glm::dvec3 lift_{0.0};  // what the person holds against: m off the goal at which the arm is wanted
  glm::dvec3 brace_{0.0};
  Wrench felt_;
  double last_ = 0.0;   // simulated s
  double lived_ = 0.0;  // s that the arm has lived since it began
  bool begun_ = false;
  bool took_weight_ = false;
  std::array<Seen, kSeen> seen_{};
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
};

}  // namespace slosh
