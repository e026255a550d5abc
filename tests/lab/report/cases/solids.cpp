// What has set bends: a beam that sticks out from between two jaws, under its own weight.
#include <cmath>

#include "tests/lab/report/error_case.h"
#include "tests/lab/report/scene_builder.h"

namespace slosh::report {
namespace {

constexpr double kBeamDensity = 1000.0, kBeamModulus = 1e6;            // kg/m³, Pa
constexpr double kBeamThick = 0.03, kBeamWide = 0.03, kBeamFree = 0.16;  // m
constexpr double kBeamHeld = 0.06, kJaw = 0.03;                          // m
constexpr double kBeamRoot = 0.015;  // m from the jaws, where that line is taken

// m, by which the end of so long a piece lies below the line that its middle has where the piece begins: by
// Euler and Bernoulli, less the slant that shear gives that line (Timoshenko), for a Poisson's ratio of a
// quarter. What holds the beam before does not count.
double sag_of_beam(double length) {
  constexpr double kShearArea = 5.0 / 6.0;
  const double bent =
      1.5 * kBeamDensity * kGravity * std::pow(length, 4) / (kBeamModulus * kBeamThick * kBeamThick);
  const double sheared = kBeamDensity * kGravity * length * length / (2.0 * kShearArea * kBeamModulus / 2.5);
  return bent - sheared;
}

// m: the same of the world. Jaws of particles give, and the beam bends between them, too.
double sag_below_root(const Snapshot& before, const Snapshot& now, double spacing) {
  double n = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  Average end_x, end_y;
  for (std::size_t i = 0; i < before.positions.size(); ++i) {
    const double x = before.positions[i].x, y = now.positions[i].y - before.positions[i].y;
    if (x > 0.0 && x < 2.0 * kBeamRoot) {
      n += 1.0;
      sum_x += x;
      sum_y += y;
      sum_xx += x * x;
      sum_xy += x * y;
    } else if (x > kBeamFree - 2.0 * spacing) {
      end_x.add(x);
      end_y.add(y);
    }
  }
  const double slope = (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
  return sum_y / n + slope * (end_x.mean() - sum_x / n) - end_y.mean();
}

std::vector<Reading> cantilever(const Setting& setting, Cost& cost) {
  SceneBuilder b;
  Fluid& batter = b.scene.fluids[static_cast<std::size_t>(b.add_fluid(kBeamDensity, 1.0))];
  batter.heat.starts_set = true;
  batter.heat.melts_above = 100.0;
  batter.heat.melts_in = 1.0;
  batter.heat.modulus = kBeamModulus;
  batter.heat.set_times = 1000.0;
  constexpr double kWide = 0.5 * kBeamWide, kHalf = 0.5 * kBeamThick, kOut = kWide + kJaw;
  b.scene.stiffness = 900.0;  // jaws that give less than the beam does
  b.add_fixed("under", make::box({-kBeamHeld, -kHalf - kJaw, -kOut}, {0.0, -kHalf, kOut}));
  b.add_fixed("over", make::box({-kBeamHeld, kHalf, -kOut}, {0.0, kHalf + kJaw, kOut}));
  b.add_volume(make::box({-kBeamHeld, -kHalf, -kWide}, {kBeamFree, kHalf, kWide}));
  b.set_domain({-0.2, -0.2, -0.2}, {0.25, 0.2, 0.2});
  Trial e(b.scene, setting, cost);
  const Snapshot start = e.picture();
  e.run(1.2);
  Average sag;
  e.run(0.3, [&] { sag.add(sag_below_root(start, e.picture(), setting.spacing)); });
  const double length = kBeamFree - setting.spacing - kBeamRoot;  // to the middle of the two last layers
  return {{"sag of the end", "m", sag.mean(), sag_of_beam(length), 0.0, true}};
}

}  // namespace

std::vector<ErrorCase> solid_cases() {
  return {{"cantilever",
           "A beam of set batter bends",
           "Euler–Bernoulli with Timoshenko's shear",
           {0.006, 0.005, 0.00375, 0.003},
           1,
           cantilever}};
}

}  // namespace slosh::report
