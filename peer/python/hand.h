// Where a hand in a Python program's world is, moment by moment.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <variant>

#include "peer/haptics/pose_track.h"
#include "peer/python/arrays.h"
#include "scenes/scene.h"
#include "sim/world.h"

namespace slosh::python {

/// A motion that is known beforehand: slosh.Keys.
struct Keys {
  std::vector<PoseKey> keys;
};

/// One grip's hand: lets go, stands, follows keys, or asks a Python function for each step.
class Hand {
 public:
  /// `rest`: where the grip is at the start; what a pose without an orientation has.
  Hand(const Pose& rest, const Grip& grip);

  /// None, "script", a pose, Keys, or a callable of the time. With Python's lock. Raises TypeError,
  /// ValueError.
  void hold(const py::object& source);
  bool calls() const { return std::holds_alternative<py::function>(motion_); }
  /// The input of the step that begins at `time` (s, simulated), `step` s after the one before. With Python's
  /// lock where calls(). The velocity of a function that gives none is that of its way since the call before.
  HandleInput at(double time);

 private:
  HandleInput asked(double time);

  Pose rest_;
  std::vector<PoseKey> script_;
  std::variant<std::monostate, HandPose, PoseTrack, py::function> motion_;
  std::optional<Pose> last_;
  double last_time_ = 0.0;
};

}  // namespace slosh::python
