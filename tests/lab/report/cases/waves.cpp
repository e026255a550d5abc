// The first sloshing mode: ω² = (πg/L) tanh(πh/L), less what its height and its boundary layers take.
#include <algorithm>
#include <cmath>

#include "tests/lab/report/error_case.h"
#include "tests/lab/report/scene_builder.h"

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

// The first mode of a tank: cos(πx/L) · cosh(π(y + h)/L), its surface swinging by `amplitude` at first. SI.
struct FirstMode {
  double length, width, depth, amplitude;

  double wave_number() const { return kPi / length; }
  /// rad/s of a small wave in a fluid without viscosity.
  double linear() const { return std::sqrt(wave_number() * kGravity * std::tanh(wave_number() * depth)); }
  /// What of its frequency the wave loses in units of (wave number · amplitude)²: Tadjbakhsh and Keller 1960.
  double loss_by_amplitude() const {
    const double w = std::sqrt(std::tanh(wave_number() * depth));
    const double second =
        (9.0 * std::pow(w, -7) - 12.0 * std::pow(w, -3) - 3.0 * w - 2.0 * std::pow(w, 5)) / 32.0;
    return -0.5 * second / w;
  }
  /// 1/s by which the walls' boundary layers bring the swing down (Keulegan 1959): half of what they burn,
  /// ρωδ/4 · |velocity along the wall|² an area, over the wave's energy; δ = √(2ν/ω). For a velocity
  /// potential of 1 m²/s.
  double decay(double viscosity) const {
    const double k = wave_number(), layer = std::sqrt(2.0 * viscosity / linear());
    const double floor = 0.5 * length * width;
    const double ends = 2.0 * width * (std::sinh(2.0 * k * depth) / (4.0 * k) - 0.5 * depth);
    const double sides = length * std::sinh(2.0 * k * depth) / (2.0 * k);
    const double burnt = 0.25 * linear() * layer * k * k * (floor + ends + sides);
    const double energy = 0.25 * width * length * k * std::sinh(k * depth) * std::cosh(k * depth);
    return 0.5 * burnt / energy;
  }
};

// 0.32 m long, 0.16 m wide and deep, the surface lifted by a half-wave of 2 cm; the depth is that of the mass
// there is. Of the period +0.35 % is the height's, +0.22 % the boundary layers' (they burn and they lag
// alike: Mei and Liu 1973). The width is the same at all spacings: walls take hold of a layer of particles,
// and of a tank of eight spacings that is a share which no spacing makes smaller.
std::vector<Reading> sloshing(const Setting& setting, Cost& cost) {
  constexpr double kLength = 0.32, kWidth = 0.16, kDepth = 0.16, kAmplitude = 0.02, kPeriods = 4.4;
  constexpr double kViscosity = 0.001, kDensity = 1000.0;
  SceneBuilder b;
  b.add_fluid(kDensity, kViscosity);
  b.add_fixed("tank", tank_at_floor({kLength, 0.28, kWidth}, 0.04));
  b.add_volume(
      make::box({-0.5 * kLength, 0.0, -0.5 * kWidth}, {0.5 * kLength, kDepth + kAmplitude, 0.5 * kWidth}));
  b.set_domain({-0.4, -0.2, -0.4}, {0.4, 0.5, 0.4});
  SampledScene cut = sampled_for(b.scene, setting);
  std::erase_if(cut.fluid_positions, [&](const glm::vec3& p) {
    return p.y >= kDepth - kAmplitude * std::sin(kPi * p.x / kLength);
  });
  cut.fluid_velocities.assign(cut.fluid_positions.size(), glm::vec3(0.0f));
  cut.fluid_index.assign(cut.fluid_positions.size(), 0);
  Trial e(b.scene, cut, setting, cost);
  const FirstMode mode{kLength, kWidth, e.fluid_mass() / (kDensity * kLength * kWidth), kAmplitude};
  const double linear = 2.0 * kPi / mode.linear(), decay = mode.decay(kViscosity / kDensity);
  const double kept = std::exp(-decay * linear);
  const double times = 2.0 * decay * kPeriods * linear;
  const double square = std::pow(mode.wave_number() * kAmplitude, 2) * (1.0 - std::exp(-times)) / times;
  const double period = linear * (1.0 + mode.loss_by_amplitude() * square + decay / mode.linear());
  std::vector<glm::dvec2> track;
  e.run(kPeriods * period, [&] { track.emplace_back(e.world().time(), e.world().diagnostics().center.x); });
  // The largest swing of the first period and of the fourth.
  double first = 0.0, last = 0.0;
  for (const glm::dvec2& p : track) {
    if (p.x < 1.1 * period) first = std::max(first, std::abs(p.y));
    if (p.x > 3.25 * period && p.x < 4.35 * period) last = std::max(last, std::abs(p.y));
  }
  return {{"period", "s", period_of(track), period, 0.0, true},
          {"swing kept a period", "", std::cbrt(last / first), kept, 1.0, true}};
}

}  // namespace

std::vector<ErrorCase> wave_cases() {
  return {{"sloshing",
           "Water swings in a tank of 0.32 m",
           "ω² = (πg/L) tanh(πh/L), finite height and boundary layers",
           {0.016, 0.01, 0.008, 0.005},
           1,
           sloshing}};
}

}  // namespace slosh::report
