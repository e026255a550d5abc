// Where the fluid's surface is, read from a picture of the world.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "sim/snapshot.h"

namespace slosh::report {

inline constexpr std::uint8_t kRetired = 255;  ///< the fluid of a particle that has left the world

/// m: mean of fluid_level (sim/instruments.h) over a grid of places between `low` and `high` (x, z).
double surface_level(const Snapshot& picture, const glm::dvec2& low, const glm::dvec2& high, double spacing);

/// The room in a vessel: a box in its frame, m. What is over an open one's rim (`high.y`) has not passed a
/// wall.
struct Room {
  glm::dvec3 low, high;
  bool open = false;
};
/// How many particles are outside of it, where the vessel stands now. Those that have left the world are.
std::size_t count_outside(const Snapshot& picture, const Pose& vessel, const Room& room);
/// The same as a share of all.
double share_outside(const Snapshot& picture, const Pose& vessel, const Room& room);

/// How many particles stand in each part of a range, mean over the pictures that were added.
class Profile {
 public:
  explicit Profile(int parts) : counts_(static_cast<std::size_t>(parts), 0.0) {}
  /// `place(position)` is 0–1 within the range; what lies outside is not counted.
  template <class Place>
  void add(const Snapshot& picture, Place&& place) {
    pictures_ += 1.0;
    for (std::size_t i = 0; i < picture.positions.size(); ++i) {
      if (picture.fluid_index[i] == kRetired) continue;
      const double at = place(picture.positions[i]) * static_cast<double>(counts_.size());
      if (at >= 0.0 && at < static_cast<double>(counts_.size())) counts_[static_cast<std::size_t>(at)] += 1.0;
    }
  }
  double mean(int part) const { return counts_[static_cast<std::size_t>(part)] / pictures_; }

 private:
  std::vector<double> counts_;
  double pictures_ = 0.0;
};

/// The slope of the straight line nearest to points (x, y).
double slope_of(const std::vector<glm::dvec2>& points);

/// What a particle has of a flow whose shape is known: along as many axes as the shape has, the others 0.
struct Along {
  glm::dvec2 measured{0.0};  ///< its way or its speed
  glm::dvec2 shape{0.0};     ///< 0: it does not count
};
/// The share of a known shape that comes nearest to what the particles have (least squares), in units of
/// measured over shape. `of(i, from, to)` gives particle i's Along from where it was, m, in `before` and is
/// in `now`, pictures of one world; those that have left it are not asked for.
template <class Of>
double share_of_shape(const Snapshot& before, const Snapshot& now, Of&& of) {
  double along = 0.0, square = 0.0;
  for (std::size_t i = 0; i < now.positions.size(); ++i) {
    if (now.fluid_index[i] == kRetired) continue;
    const Along a = of(i, glm::dvec3(before.positions[i]), glm::dvec3(now.positions[i]));
    along += glm::dot(a.shape, a.measured);
    square += glm::dot(a.shape, a.shape);
  }
  return along / square;
}

}  // namespace slosh::report
