// Bodies without a fluid.
#include <algorithm>
#include <cmath>

#include "tests/lab/report/error_case.h"
#include "tests/lab/report/scene_builder.h"

namespace slosh::report {
namespace {

// A box falls 0.2 m flat on a table of restitution 0.6: it comes up e² as high. The spacing is that of the
// points that touch.
std::vector<Reading> bounce(const Setting& setting, Cost& cost) {
  constexpr double kDrop = 0.2, kRestitution = 0.6, kHalf = 0.03;
  SceneBuilder b;
  b.add_fixed("table", make::box({-0.3, -0.06, -0.3}, {0.3, 0.0, 0.3}));
  const int box = b.add_free("box", make::box(glm::dvec3(-kHalf), glm::dvec3(kHalf)), 0.2,
                             {{0.0, kHalf + kDrop, 0.0}, {1, 0, 0, 0}});
  for (Body& body : b.scene.bodies) body.restitution = kRestitution;
  b.set_domain({-1, -1, -1}, {1, 1, 1});
  Trial e(b.scene, setting, cost);
  const double fall = std::sqrt(2.0 * kDrop / kGravity);
  e.run(1.05 * fall);
  double highest = 0.0;
  e.run(kRestitution * fall * 1.5, [&] {
    highest = std::max(highest, e.bodies().bodies[static_cast<std::size_t>(box)].center_of_mass.y - kHalf);
  });
  return {{"rebound", "m", highest, kDrop * kRestitution * kRestitution, 0.0, true}};
}

}  // namespace

std::vector<ErrorCase> contact_cases() {
  return {{"bounce", "A box bounces on a table", "e² of the height", {0.015, 0.01}, 1, bounce}};
}

}  // namespace slosh::report
