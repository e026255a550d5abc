// The first sloshing mode: ω² = (πg/L) tanh(πh/L).
#include <algorithm>
#include <cmath>

#include "host/report/error_case.h"
#include "host/report/scene_builder.h"

namespace slosh::report {
namespace {

// Mean time between upward passages of the mean.
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

// 0.32 m long, 0.16 m deep, the surface lifted by a half-wave of 2 cm. Linear theory holds to (amplitude/L)²,
// the depth is that of the mass there is. Viscosity takes 1 to 2 % a period of such a wave (boundary layers).
std::vector<Reading> sloshing(const Setting& setting, Cost& cost) {
  constexpr double kLength = 0.32, kDepth = 0.16, kAmplitude = 0.02;
  const double width = 8.0 * setting.spacing;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_fixed("tank", tank_at_floor({kLength, 0.28, width}, 0.04));
  b.add_volume(
      make::box({-0.5 * kLength, 0.0, -0.5 * width}, {0.5 * kLength, kDepth + kAmplitude, 0.5 * width}));
  b.set_domain({-0.4, -0.2, -0.4}, {0.4, 0.5, 0.4});
  const Result<SampledScene> sampled = sample_scene(b.scene, setting.spacing);
  if (!sampled) throw Refused(sampled.error());
  SampledScene cut = sampled.value();
  std::erase_if(cut.fluid_positions, [&](const glm::vec3& p) {
    return p.y >= kDepth - kAmplitude * std::sin(kPi * p.x / kLength);
  });
  cut.fluid_velocities.assign(cut.fluid_positions.size(), glm::vec3(0.0f));
  cut.fluid_index.assign(cut.fluid_positions.size(), 0);
  Trial e(b.scene, cut, setting, cost);
  const double depth = e.fluid_mass() / (1000.0 * kLength * width);
  const double k = kPi / kLength;
  const double period = 2.0 * kPi / std::sqrt(k * kGravity * std::tanh(k * depth));
  std::vector<glm::dvec2> track;
  e.run(4.4 * period, [&] { track.emplace_back(e.world().time(), e.world().diagnostics().center.x); });
  // The largest swing of the first period and of the fourth.
  double first = 0.0, last = 0.0;
  for (const glm::dvec2& p : track) {
    if (p.x < 1.1 * period) first = std::max(first, std::abs(p.y));
    if (p.x > 3.25 * period && p.x < 4.35 * period) last = std::max(last, std::abs(p.y));
  }
  constexpr double kLostToWalls = 0.015;  // a share a period
  return {{"period", "s", period_of(track), period, 0.0, true},
          {"swing kept a period", "", std::cbrt(last / first), 1.0 - kLostToWalls, 1.0, true}};
}

}  // namespace

std::vector<ErrorCase> wave_cases() {
  return {{"sloshing",
           "Water swings in a tank of 0.32 m",
           "ω² = (πg/L) tanh(πh/L)",
           {0.016, 0.01, 0.008, 0.005},
           1,
           sloshing}};
}

}  // namespace slosh::report
