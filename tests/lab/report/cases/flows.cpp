// Water that runs: fronts, an impact on a column, a jet.
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "tests/lab/report/error_case.h"
#include "tests/lab/report/reference/potential_dam.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/surface.h"

namespace slosh::report {
namespace {

// Koshizuka and Oka 1996, as digitised in PySPH: t√(2g/L), front/L.
constexpr glm::dvec2 kKoshizukaOka[] = {{0.769, 1.252}, {1.153, 1.505}, {1.537, 1.892}, {1.935, 2.241},
                                        {2.323, 2.615}, {2.719, 3.003}, {3.096, 3.624}};
// Martin and Moyce 1952, table 2: n² = 2, a base of 2¼ inches.
constexpr glm::dvec2 kMartinMoyce[] = {{0.41, 1.11}, {0.84, 1.22}, {1.19, 1.44}, {1.43, 1.67}, {1.63, 1.89},
                                       {1.83, 2.11}, {1.98, 2.33}, {2.20, 2.56}, {2.32, 2.78}, {2.51, 3.00},
                                       {2.65, 3.22}, {2.83, 3.44}, {2.98, 3.67}, {3.11, 3.89}, {3.33, 4.11}};

// How far, from its left wall, a tank is wet without a gap: every slice of a spacing holds half a row of
// particles or more. Single drops that fly ahead do not count.
double wet_length(const std::vector<glm::vec3>& positions, double left, double width, double spacing) {
  std::vector<double> count, furthest;
  for (const glm::vec3& p : positions) {
    const auto slice = static_cast<std::size_t>(std::max(0.0, (p.x - left) / spacing));
    if (slice >= count.size()) {
      count.resize(slice + 1, 0.0);
      furthest.resize(slice + 1, 0.0);
    }
    count[slice] += 1.0;
    furthest[slice] = std::max(furthest[slice], p.x - left);
  }
  double wet = 0.0;
  for (std::size_t i = 0; i < count.size() && count[i] >= 0.5 * width / spacing; ++i) wet = furthest[i];
  return wet + 0.5 * spacing;
}

// Where a line through points that ascend both ways has its coordinate `from` (0: x, 1: y) at `at`: the other
// one there.
double line_at(std::span<const glm::dvec2> line, double at, int from) {
  std::size_t i = 1;
  while (i + 1 < line.size() && line[i][from] < at) ++i;
  const glm::dvec2 a = line[i - 1], b = line[i];
  const double way = b[from] - a[from];
  return way > 0.0 ? glm::mix(a[1 - from], b[1 - from], (at - a[from]) / way) : b[1 - from];
}

// A column L wide and 2 L high is let go at once: potential flow says where its front is, as deep as half a
// row of particles. In an experiment letting go takes its time, and a film tells when it began as well as it
// can: so besides the film's front its speed over `way`, from and to in L, which no lag changes.
std::vector<Reading> dam_break(std::span<const glm::dvec2> fronts, const glm::dvec2& way, double length,
                               double room, double width, const Setting& setting, Cost& cost) {
  const double left = -0.5 * room * length;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_fixed("tank", tank_at_floor({room * length, 3.0 * length, width}, 4.0 * setting.spacing));
  b.add_volume(make::box({left, 0.0, -0.5 * width}, {left + length, 2.0 * length, 0.5 * width}));
  b.set_domain({2.0 * left, -length, -length}, {-2.0 * left, 5.0 * length, length});
  Trial e(b.scene, setting, cost);
  const double second = std::sqrt(2.0 * kGravity / length);
  std::vector<glm::dvec2> track{{0.0, 1.0}};
  e.run((fronts.back().x + 0.05) / second, [&] {
    const double wet = wet_length(e.picture().positions, left, width, setting.spacing) / length;
    track.emplace_back(e.world().time() * second, std::max(track.back().y, wet));
  });
  static const std::vector<DamSurface> ideal = potential_dam(2.0, 3.4);
  double worst = 0.0, worst_of_ideal = 0.0;
  std::vector<Reading> readings;
  for (const glm::dvec2& f : fronts) {
    const double front = line_at(track, f.x, 0);
    const double truth = front_at(ideal, f.x, 0.5 * setting.spacing / length);
    readings.push_back({"front at " + std::to_string(f.x).substr(0, 5), "L", front, f.y, 0.0, false});
    worst = std::max(worst, std::abs(readings.back().error()));
    // Beyond the far wall nothing is compared.
    if (truth < room) worst_of_ideal = std::max(worst_of_ideal, std::abs(front / truth - 1.0));
  }
  const auto speed = [&](std::span<const glm::dvec2> line) {
    return (way.y - way.x) / (line_at(line, way.y, 1) - line_at(line, way.x, 1));
  };
  readings.insert(readings.begin(),
                  {{"front against potential flow, worst", "", worst_of_ideal, 0.0, 1.0, true},
                   {"front, worst", "", worst, 0.0, 1.0, false},
                   {"speed of the front", "√(2gL)", speed(track), speed(fronts), 0.0, false}});
  return readings;
}

std::vector<Reading> koshizuka_oka(const Setting& setting, Cost& cost) {
  constexpr double kBase = 0.146;
  return dam_break(kKoshizukaOka, {1.505, 3.003}, kBase, 4.0, 0.5 * kBase, setting, cost);
}

std::vector<Reading> martin_moyce(const Setting& setting, Cost& cost) {
  constexpr double kBase = 0.05715;
  return dam_break(kMartinMoyce, {1.44, 4.11}, kBase, 6.0, kBase, setting, cost);
}

// Yeh & Petroff: t s, N along the flow.
constexpr glm::dvec2 kColumnForce[] = {{0.33, 1.0},   {0.367, 25.0}, {0.396, 33.1}, {0.445, 24.9},
                                       {0.504, 19.7}, {0.60, 18.0},  {0.75, 16.3},  {0.85, 14.9},
                                       {1.00, 8.8},   {1.20, 4.9}};

// The largest mean of a line over `window` of its x.
double largest_mean(std::span<const glm::dvec2> line, double window) {
  std::vector<double> area{0.0};
  for (std::size_t i = 1; i < line.size(); ++i)
    area.push_back(area.back() + 0.5 * (line[i].y + line[i - 1].y) * (line[i].x - line[i - 1].x));
  const auto until = [&](double x) {
    std::size_t i = 1;
    while (i + 1 < line.size() && line[i].x < x) ++i;
    const double share = (x - line[i - 1].x) / (line[i].x - line[i - 1].x);
    const double there = glm::mix(line[i - 1].y, line[i].y, share);
    return area[i - 1] + 0.5 * (line[i - 1].y + there) * (x - line[i - 1].x);
  };
  double most = 0.0;
  for (double x = line.front().x; x + window <= line.back().x; x += 1e-3)
    most = std::max(most, (until(x + window) - until(x)) / window);
  return most;
}

// A column of 12 cm stands in the way of a dam break. The impulse of the first wave from the moment on that
// it reaches the column, for as long as the experiment's readings go, and the largest mean over 40 ms, which
// is how far those lie apart at their peak; when the wave is there stands beside it: the experiment's gate is
// not ours. Its floor could not be drained: about a centimetre of water stood on it (Gómez-Gesteira and
// Dalrymple 2004), here a layer of particles at least.
std::vector<Reading> column(const Setting& setting, Cost& cost) {
  constexpr double kLength = 1.6, kWidth = 0.61, kHeight = 0.4, kDam = 0.4, kDepth = 0.3, kHalf = 0.06;
  constexpr double kPeak = 0.04;  // s
  const double wet = std::max(0.01, setting.spacing);
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_fixed("tank", tank_at_floor({kLength, kHeight, kWidth}, 0.06));
  const double left = -0.5 * kLength;
  const int post = b.add_fixed("column", make::box({-kHalf, 0.0, -kHalf}, {kHalf, 0.75, kHalf}),
                               {{left + 0.96, 0.0, 0.0}, {1, 0, 0, 0}});
  b.add_volume(make::box({left, 0.0, -0.5 * kWidth}, {left + kDam, kDepth, 0.5 * kWidth}));
  b.add_volume(make::box({left + kDam, 0.0, -0.5 * kWidth}, {0.5 * kLength, wet, 0.5 * kWidth}));
  b.set_domain({-1.2, -0.3, -0.6}, {1.2, 1.2, 0.6});
  Trial e(b.scene, setting, cost);
  std::vector<glm::dvec2> force;
  e.run(1.2, [&] {
    force.emplace_back(e.world().time(), e.bodies().bodies[static_cast<std::size_t>(post)].fluid.force.x);
  });
  const double dt = e.world().plan().time_step;
  const double lasts = kColumnForce[std::size(kColumnForce) - 1].x - kColumnForce[0].x;
  // There: 5 N in the mean of 10 ms. What a pressure wave gives before the water comes is less.
  const auto window = static_cast<std::size_t>(std::max(1.0, 0.01 / dt));
  double there = 0.0, sum = 0.0, impulse = 0.0;
  for (std::size_t i = 0; i < force.size() && there == 0.0; ++i) {
    sum += force[i].y - (i >= window ? force[i - window].y : 0.0);
    if (i + 1 >= window && sum > 5.0 * static_cast<double>(window)) there = force[i + 1 - window].x;
  }
  for (const glm::dvec2& f : force)
    if (f.x >= there && f.x < there + lasts) impulse += dt * f.y;
  double expected = 0.0;
  for (std::size_t i = 1; i < std::size(kColumnForce); ++i) {
    expected +=
        0.5 * (kColumnForce[i].y + kColumnForce[i - 1].y) * (kColumnForce[i].x - kColumnForce[i - 1].x);
  }
  return {{"impulse", "N·s", impulse, expected, 0.0, true},
          {"peak", "N", largest_mean(force, kPeak), largest_mean(kColumnForce, kPeak), 0.0, true},
          {"wave there", "s", there, kColumnForce[0].x, 0.0, false}};
}

// Water runs out of a hole of 30 mm in the floor: √(2g·depth), at 30 mm under the floor's underside.
std::vector<Reading> torricelli(const Setting& setting, Cost& cost) {
  constexpr double kRadius = 0.06, kHole = 0.015, kFloor = 0.02, kFill = 0.12, kBelow = 0.03;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_fixed("vessel", glass_of(kRadius, kFill + 0.04, kFloor, kHole));
  b.add_volume(filling_of(kRadius, kFill));
  b.set_domain({-0.2, -0.25, -0.2}, {0.2, 0.4, 0.2});
  Trial e(b.scene, setting, cost);
  e.run(0.12);
  Average share;
  Snapshot before = e.picture();
  e.run(0.1, [&] {
    const Snapshot now = e.picture();
    double above = 0.0;
    for (std::size_t i = 0; i < now.positions.size(); ++i)
      above += now.fluid_index[i] != kRetired && now.positions[i].y > 0.0f;
    const double depth = above * std::pow(setting.spacing, 3) / (kPi * kRadius * kRadius);
    const double plane = -kFloor - kBelow;
    for (std::size_t i = 0; i < now.positions.size(); ++i) {
      if (now.fluid_index[i] == kRetired || std::abs(now.positions[i].y - plane) > setting.spacing) continue;
      const glm::dvec3 way = glm::dvec3(now.positions[i]) - glm::dvec3(before.positions[i]);
      const double speed = glm::length(way) / e.world().plan().time_step;
      share.add(speed / std::sqrt(2.0 * kGravity * (depth - now.positions[i].y)));
    }
    before = now;
  });
  return {{"speed of the jet over Torricelli's", "", share.count() > 0 ? share.mean() : 0.0, 1.0, 0.0, true}};
}

// A mug is poured over a funnel into a tray with a rim of 5 cm: what somebody models first. All of the water
// should be in mug, funnel and tray in the end.
std::vector<Reading> poured_mug(const Setting& setting, Cost& cost) {
  constexpr double kSeconds = 5.5;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_fixed("tray", tank_at_floor({0.36, 0.05, 0.36}, 0.02));
  b.add_fixed(
      "funnel",
      make::lathe({{0.037, 0.10}, {0.037, 0.15}, {0.12, 0.225}, {0.11, 0.24}, {0.025, 0.16}, {0.025, 0.10}},
                  64));
  const Pose stands{{0.118, 0.255, 0.0}, {1, 0, 0, 0}};
  const int mug = b.add_free(
      "mug",
      make::lathe({{0.0, 0.0}, {0.058, 0.0}, {0.058, 0.11}, {0.046, 0.11}, {0.046, 0.012}, {0.0, 0.012}}, 64),
      0.3, stands);
  b.add_volume(make::lathe({{0.0, 0.0125}, {0.0455, 0.0125}, {0.0455, 0.0985}, {0.0, 0.0985}}, 64), 0,
               stands);
  const int lip = b.add_grip(mug, 1000.0, 20.0, 10.0, 0.2, {{-0.058, 0.11, 0.0}, {1, 0, 0, 0}});
  const auto hand = [](double time) {
    const double share = 0.5 - 0.5 * std::cos(kPi * std::clamp((time - 0.3) / 3.5, 0.0, 1.0));
    return Pose{{0.06, 0.365, 0.0}, glm::angleAxis(2.0 * share, glm::dvec3(0, 0, 1))};
  };
  for (int i = 0; i <= 330; ++i)
    b.scene.grips[static_cast<std::size_t>(lip)].hand_motion.push_back(
        {i * kSeconds / 330, hand(i * kSeconds / 330)});
  b.set_domain({-0.4, -0.22, -0.4}, {0.4, 0.57, 0.4});
  Trial e(b.scene, setting, cost);
  HandleInput& handle = e.handle(0);
  handle.engaged = true;
  const double before = e.fluid_mass();
  e.run(kSeconds, [&] {
    const double time = e.world().time(), tick = e.world().plan().time_step;
    handle.pose = hand(time + tick);
    handle.twist.angular = rotation_between(hand(time).orientation, hand(time + tick).orientation) / tick;
  });
  return {{"water kept", "kg", e.fluid_mass(), before, 0.0, true}};
}

}  // namespace

std::vector<ErrorCase> flow_cases() {
  return {
      {"dam_break",
       "A dam of 146 mm breaks",
       "boundary elements; film of Koshizuka and Oka",
       {0.146 / 12, 0.146 / 16, 0.146 / 24},
       1,
       koshizuka_oka},
      {"dam_break_long",
       "A dam of 57 mm breaks",
       "boundary elements; film of Martin and Moyce",
       {0.05715 / 10, 0.05715 / 14, 0.05715 / 20},
       1,
       martin_moyce},
      {"column", "A dam breaks against a column", "experiment of Yeh and Petroff", {0.012, 0.01}, 1, column},
      {"torricelli", "Water runs out of a hole", "√(2gh)", {0.01, 0.0075, 0.006, 0.005}, 1, torricelli},
      {"mug",
       "A mug is poured over a funnel into a tray",
       "all of it stays",
       {0.01, 0.008, 0.006},
       1,
       poured_mug},
  };
}

}  // namespace slosh::report
