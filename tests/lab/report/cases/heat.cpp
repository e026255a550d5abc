// Conduction: a slab of fluid on a hot floor, and one that touches a second fluid.
#include <cmath>

#include "tests/lab/report/error_case.h"
#include "tests/lab/report/scene_builder.h"

namespace slosh::report {
namespace {

// Fluid that conducts heat as fast as an experiment of a second needs: α = 6·10⁻³ m²/s.
constexpr double kOvenDensity = 1000.0, kOvenCapacity = 1000.0, kOvenConductivity = 6000.0,
                 kOvenViscosity = 0.5;
constexpr double kOvenDiffusivity = kOvenConductivity / (kOvenDensity * kOvenCapacity);
constexpr double kOvenSide = 0.08, kOvenHeight = 0.1, kOvenWall = 0.03;  // m
constexpr double kCold = 20.0, kHot = 80.0;                              // °C

// Floor and four walls, each its own body; only the floor has a temperature. Returns the floor.
int add_oven(SceneBuilder& b) {
  constexpr double kIn = 0.5 * kOvenSide, kOut = kIn + kOvenWall, kTop = kOvenHeight + 0.03;
  const int floor = b.add_fixed("floor", make::box({-kOut, -kOvenWall, -kOut}, {kOut, 0.0, kOut}));
  b.add_fixed("left", make::box({-kOut, 0.0, -kOut}, {-kIn, kTop, kOut}));
  b.add_fixed("right", make::box({kIn, 0.0, -kOut}, {kOut, kTop, kOut}));
  b.add_fixed("back", make::box({-kIn, 0.0, -kOut}, {kIn, kTop, -kIn}));
  b.add_fixed("front", make::box({-kIn, 0.0, kIn}, {kIn, kTop, kOut}));
  b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2});
  return floor;
}

void add_layer(SceneBuilder& b, int fluid, double from, double to) {
  constexpr double kIn = 0.5 * kOvenSide;
  b.add_volume(make::box({-kIn, from, -kIn}, {kIn, to, kIn}), fluid);
}

void make_conductor(Fluid& fluid, double conductivity, double temperature) {
  fluid.heat.capacity = kOvenCapacity;
  fluid.heat.conductivity = conductivity;
  fluid.heat.temperature = temperature;
}

// The share of the way to the floor's temperature, `height` m above it, in fluid `depth` m deep whose surface
// lets nothing out, after `time` s; and the mean of it over the depth.
double warmed_at(double height, double depth, double time) {
  double left = 0.0;
  for (int n = 0; n < 200; ++n) {
    const double k = (n + 0.5) * kPi / depth;
    left += 2.0 / (k * depth) * std::sin(k * height) * std::exp(-k * k * kOvenDiffusivity * time);
  }
  return 1.0 - left;
}
double warmed(double depth, double time) {
  double left = 0.0;
  for (int n = 0; n < 200; ++n) {
    const double k = (n + 0.5) * kPi;
    left += 2.0 / (k * k) * std::exp(-k * k * kOvenDiffusivity * time / (depth * depth));
  }
  return 1.0 - left;
}

// °C, mean over the particles between two heights.
double mean_between(const Trial& e, World& world, double low, double high) {
  std::vector<float> temperatures, cures;
  world.fill_heat(temperatures, cures);
  const Snapshot now = e.picture();
  Average mean;
  for (std::size_t i = 0; i < temperatures.size(); ++i)
    if (now.positions[i].y > low && now.positions[i].y < high) mean.add(temperatures[i]);
  return mean.mean();
}

std::vector<Reading> slab(const Setting& setting, Cost& cost) {
  SceneBuilder b;
  make_conductor(b.scene.fluids[static_cast<std::size_t>(b.add_fluid(kOvenDensity, kOvenViscosity))],
                 kOvenConductivity, kCold);
  b.scene.bodies[static_cast<std::size_t>(add_oven(b))].temperature = kHot;
  add_layer(b, 0, 0.0, kOvenHeight);
  Trial e(b.scene, setting, cost);
  e.settle(0.3);
  const Diagnostics before = e.world().diagnostics();
  const double depth = before.mass / (kOvenDensity * kOvenSide * kOvenSide);
  const double whole = before.mass * kOvenCapacity * (kHot - kCold);
  std::vector<Reading> readings;
  for (const int ms : {250, 1000}) {
    e.run(1e-3 * ms - e.world().time());
    const Diagnostics now = e.world().diagnostics();
    const double time = e.world().time();
    const std::string at = " after " + std::to_string(ms) + " ms";
    readings.push_back(
        {"heat taken up" + at, "J", now.heat - before.heat, whole * warmed(depth, time), 0.0, true});
    if (ms == 250) continue;
    const double low = 0.4 * depth, high = 0.6 * depth;
    readings.push_back({"warmth in the middle" + at, "°C", mean_between(e, e.world(), low, high),
                        kCold + (kHot - kCold) * warmed_at(0.5 * depth, depth, time), kHot - kCold});
    readings.push_back({"heat that came from nowhere", "J", now.heat - before.heat - now.heat_from_bodies,
                        0.0, now.heat - before.heat});
  }
  return readings;
}

// A hot fluid under a cold one that conducts a quarter as well, both deep: where they touch, the warmth is at
// once what it stays.
std::vector<Reading> touching(const Setting& setting, Cost& cost) {
  constexpr double kPoor = 0.25 * kOvenConductivity;
  SceneBuilder b;
  const int hot = b.add_fluid(1.05 * kOvenDensity, kOvenViscosity),
            cold = b.add_fluid(kOvenDensity, kOvenViscosity);
  make_conductor(b.scene.fluids[static_cast<std::size_t>(hot)], kOvenConductivity / 1.05, kHot);
  make_conductor(b.scene.fluids[static_cast<std::size_t>(cold)], kPoor, kCold);
  add_oven(b);
  constexpr double kMiddle = 0.6 * kOvenHeight;
  add_layer(b, hot, 0.0, kMiddle);
  add_layer(b, cold, kMiddle, kOvenHeight);
  Trial e(b.scene, setting, cost);
  e.settle(0.3);
  const double before = e.world().diagnostics().heat;
  constexpr double kTime = 0.06;  // s; the nearer end feels it after 0.2
  e.run(kTime);
  // What went over is as of two half spaces: 2 √(t/π) (T₁ − T₂) / (1/e₁ + 1/e₂), e = √(kρc).
  std::vector<float> temperatures, cures;
  e.world().fill_heat(temperatures, cures);
  const Snapshot now = e.picture();
  double gained = 0.0;
  const double each = kOvenDensity * std::pow(setting.spacing, 3) * kOvenCapacity;
  for (std::size_t i = 0; i < temperatures.size(); ++i)
    if (now.fluid_index[i] == cold) gained += each * (temperatures[i] - kCold);
  const double of_hot = std::sqrt(kOvenConductivity * kOvenDensity * kOvenCapacity);
  const double of_cold = std::sqrt(kPoor * kOvenDensity * kOvenCapacity);
  const double over =
      2.0 * std::sqrt(e.world().time() / kPi) * (kHot - kCold) / (1.0 / of_hot + 1.0 / of_cold);
  return {{"heat that went over", "J", gained, over * kOvenSide * kOvenSide, 0.0, true},
          {"heat lost", "J", e.world().diagnostics().heat - before, 0.0, gained}};
}

}  // namespace

std::vector<ErrorCase> heat_cases() {
  return {{"slab",
           "Fluid warms on a hot floor",
           "1-D conduction, series (Carslaw & Jaeger)",
           {0.01, 0.008, 0.005, 0.004},
           1,
           slab},
          {"touching",
           "Hot fluid under cold",
           "two half spaces (Carslaw & Jaeger)",
           {0.01, 0.008, 0.005, 0.004},
           1,
           touching}};
}

}  // namespace slosh::report
