// What a world's particles and bodies are at one moment, on its way to numpy.
#pragma once

#include <memory>
#include <vector>

#include "sim/world.h"

namespace slosh::python {

/// Arrays are views of this. Never written again once an array looks at it.
struct Moment {
  Snapshot snapshot;
  std::vector<glm::vec3> velocities;
  std::vector<float> pressures;
};

/// Fills a world's newest moment when it is asked for, one part at a time, and uses its memory again as soon
/// as no array looks at it. With Python's lock.
class Moments {
 public:
  /// The world moved or was changed.
  void outdated() { has_snapshot_ = has_velocities_ = has_pressures_ = false; }

  const std::shared_ptr<Moment>& snapshot(const World& world) {
    if (!has_snapshot_) world.fill(fresh()->snapshot);
    has_snapshot_ = true;
    return moment_;
  }
  const std::shared_ptr<Moment>& velocities(const World& world) {
    if (!has_velocities_) world.fill_velocities(fresh()->velocities);
    has_velocities_ = true;
    return moment_;
  }
  const std::shared_ptr<Moment>& pressures(const World& world) {
    if (!has_pressures_) world.fill_pressures(fresh()->pressures);
    has_pressures_ = true;
    return moment_;
  }

 private:
  /// The moment that is being filled; another one where the last is over and somebody looks at it.
  Moment* fresh() {
    const bool begins = !has_snapshot_ && !has_velocities_ && !has_pressures_;
    if (!moment_ || (begins && moment_.use_count() > 1)) moment_ = std::make_shared<Moment>();
    return moment_.get();
  }

  std::shared_ptr<Moment> moment_;
  bool has_snapshot_ = false;
  bool has_velocities_ = false;
  bool has_pressures_ = false;
};

}  // namespace slosh::python
