// The first sloshing mode: ω² = (πg/L) tanh(πh/L).
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/lab.h"
#include "tests/support/tank.h"

namespace slosh::lab {
namespace {

// Times at which the centre of mass crosses its mean, upwards: whole periods.
double period_of(const std::vector<glm::dvec2>& track) {
  double mean = 0.0;
  for (const glm::dvec2& p : track) mean += p.y;
  mean /= static_cast<double>(track.size());
  std::vector<double> up;
  for (std::size_t i = 1; i < track.size(); ++i) {
    const double a = track[i - 1].y - mean, b = track[i].y - mean;
    if (a < 0.0 && b >= 0.0) up.push_back(glm::mix(track[i - 1].x, track[i].x, -a / (b - a)));
  }
  return up.size() < 2 ? 0.0 : (up.back() - up.front()) / static_cast<double>(up.size() - 1);
}

class Sloshing : public ::testing::TestWithParam<double> {};

// 0.32 m long, 0.16 m deep, the surface lifted by a cosine of 2 cm. Linear theory holds to (amplitude/L)²,
// the depth is that of the mass there is. Reached: 0.5 % at 16 mm, 1.2 % at 10 mm (an effective length that
// walls make a little too long), and 67 and 78 % of the swing left; the consistent model had -3 % and -1.7 %,
// and 14 and 28 % left.
TEST_P(Sloshing, first_mode_period) {
  const double spacing = GetParam();
  constexpr double kLength = 0.32, kDepth = 0.16, kAmplitude = 0.02;
  testing::TankOptions options;
  options.inner = {kLength, 0.28, 8.0 * spacing};
  options.fill = kDepth + kAmplitude;
  options.spacing = spacing;
  options.viscosity = 0.001;
  testing::Tank tank = testing::make_tank(options);
  SampledScene cut = tank.sampled;
  cut.fluid_positions.clear();
  for (const glm::vec3& p : tank.sampled.fluid_positions) {
    if (p.y < kDepth - kAmplitude * std::sin(kPi * p.x / kLength)) cut.fluid_positions.push_back(p);
  }
  cut.fluid_velocities.assign(cut.fluid_positions.size(), glm::vec3(0.0f));
  cut.fluid_index.assign(cut.fluid_positions.size(), 0);
  Experiment e(tank.scene, cut);
  const double depth = e.fluid_mass() / (1000.0 * kLength * 8.0 * spacing);
  std::vector<glm::dvec2> track;
  e.run(2.8, [&] { track.emplace_back(e.world().time(), e.world().diagnostics().center.x); });
  const double k = kPi / kLength;
  const double expected = 2.0 * kPi / std::sqrt(k * kGravity * std::tanh(k * depth));
  const std::string name = "sloshing period, spacing " + std::to_string(std::lround(1e3 * spacing)) + " mm";
  EXPECT_LT(std::abs(report(name, period_of(track), expected, "s")), 0.015);
  // How much of the swing is left after about four periods: the model's own damping, for the record.
  double first = 0.0, last = 0.0;
  for (const glm::dvec2& p : track) {
    if (p.x < 0.7) first = std::max(first, std::abs(p.y));
    if (p.x > 2.1) last = std::max(last, std::abs(p.y));
  }
  report_value(name + ", swing left after 3 periods", 100.0 * last / first, "%");
  EXPECT_GT(last, (spacing > 0.012 ? 0.6 : 0.72) * first) << "the wave is damped away by the method";
  EXPECT_LT(last, 0.95 * first) << "a wave that is not damped gains";
}

INSTANTIATE_TEST_SUITE_P(spacings, Sloshing, ::testing::Values(0.016, 0.01));

}  // namespace
}  // namespace slosh::lab
