// What scenes of a kitchen share: round bowls, handles, and hands that hold both.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes/make/shipped.h"

namespace slosh::make {

/// A half sphere with a wall of kWall and a bar along -x to hold it by; its underside is at y = 0. m.
struct Bowl {
  double radius;                                 ///< inner
  double bar_from, bar_to;                       ///< x of the bar's ends
  double rim() const { return radius + kWall; }  ///< height
  double bar_height() const { return rim() - 0.014; }
  Solid solid() const;
  /// What is in it up to `below` its rim.
  Solid filling(double below) const;
};

/// A round bar along x.
Solid bar(double from, double to, double height);

/// A grip on a body's node, and the hand that carries the body along `body_pose` by it for `duration` s.
void add_held(SceneWriter& writer, const std::string& name, int node, const Pose& grip, int device,
              const std::function<Pose(double)>& body_pose, double duration);

}  // namespace slosh::make
