// Where a haptic device stands in the room that a headset tracks: found by touching places with both, kept,
// used.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/headset_hands.h"
#include "sim/math/pose.h"
#include "sim/math/result.h"

namespace slosh {

/// One place, touched by the device's tip and by a controller at once.
struct TouchedPlace {
  glm::dvec3 at_device{0.0};  ///< m, the device's own frame
  glm::dvec3 in_room{0.0};    ///< m
};

struct SharedSpace {
  Pose device_in_room;    ///< the device's frame
  double residual = 0.0;  ///< m: root mean square of what the places are off
};

constexpr std::size_t kPlacesToTouch = 3;
constexpr double kMinReach =
    0.04;  ///< m between the places that are farthest apart, and off the line between them
constexpr double kMaxResidual = 0.010;  ///< m

/// The rigid motion that brings the device's places nearest to the room's (Horn 1987). Errors: fewer than
/// three places; nearer together or nearer to one line than kMinReach; a residual above kMaxResidual:
/// device and controller did not touch the same places.
Result<SharedSpace> fit_shared_space(std::span<const TouchedPlace> places);

/// Beside the device's settings: NAME.room. Empty where there is no folder of the user's.
std::filesystem::path shared_space_file(const std::string& device);
/// Errors: the folder cannot be made, the file cannot be written.
Result<bool> keep_shared_space(const std::filesystem::path& file, const SharedSpace& space);
/// Nothing where it was never found. Errors: mistakes in the file, with their line.
Result<std::optional<SharedSpace>> kept_shared_space(const std::filesystem::path& file);

/// Takes places, one turn after another: the tip is held to a controller, both still, and its grip button or
/// trigger is closed. One thread.
class TouchPlaces {
 public:
  enum class Heard : std::uint8_t {
    kNothing,
    kTaken,
    kMoved,    ///< closed while device or controller moved
    kTooNear,  ///< nearer to a place before than kMinReach
  };
  /// `tip`: of the device in its own frame, absent while it is silent. `time` in s, rising.
  Heard follow(double time, const std::optional<glm::dvec3>& tip, const HandReading& left,
               const HandReading& right);

  const std::vector<TouchedPlace>& places() const { return places_; }
  bool complete() const { return places_.size() >= kPlacesToTouch; }
  void again() { places_.clear(); }

 private:
  struct Seen {
    double time;
    std::optional<glm::dvec3> tip;
    std::optional<glm::dvec3> hands[2];
  };
  std::vector<Seen> seen_;         // of the last kStill s
  bool closed_[2] = {true, true};  // what is closed at the beginning opens first
  std::vector<TouchedPlace> places_;
};

}  // namespace slosh
