#include "tests/lab/report/stress/scenes.h"

#include <cmath>

#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/trial.h"

namespace slosh::report {

Scene held_box(double mass, double stiffness, double damping, int grips) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("tank", tank_at_floor({0.16, 0.16, 0.16}, 0.03));
  const int box =
      b.add_free("box", make::box(glm::dvec3(-0.02), glm::dvec3(0.02)), mass, {kHeldBox, {1, 0, 0, 0}});
  b.add_volume(make::box({-0.08, 0.0, -0.08}, {0.08, 0.04, 0.08}));
  for (int g = 0; g < grips; ++g) {
    const double angle = 2.0 * kPi * g / grips;
    b.add_grip(box, stiffness, damping, 10.0, 0.2,
               {{0.03 * std::cos(angle), 0.0, 0.03 * std::sin(angle)}, {1, 0, 0, 0}});
  }
  b.set_domain({-0.5, -0.3, -0.5}, {0.5, 0.8, 0.5});
  return b.scene;
}

Scene press_scene() {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("tank", tank_at_floor({0.12, 0.2, 0.12}, 0.03));
  const int lid = b.add_free("lid", make::box({-0.058, 0.0, -0.058}, {0.058, 0.03, 0.058}), 1.0,
                             {{0.0, 0.08, 0.0}, {1, 0, 0, 0}});
  b.add_volume(make::box({-0.06, 0.0, -0.06}, {0.06, 0.07, 0.06}));
  b.add_grip(lid, 1e5, 1e3, 1e3, 10.0);
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 0.8, 0.4});
  return b.scene;
}

}  // namespace slosh::report
