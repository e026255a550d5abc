// Flows that viscosity alone decides: of a gap, as it starts and when it flows evenly, and of a vortex that
// dies.
#include <algorithm>
#include <cmath>

#include "tests/lab/report/error_case.h"
#include "tests/lab/report/reference/ring_flow.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/surface.h"

namespace slosh::report {
namespace {

constexpr double kInner = 0.03, kOuter = 0.05;  // m, the gap's two walls
constexpr double kViscosity = 1.0, kDensity = 1000.0;

// A rod that suddenly turns in a glass filled to `height`, for `lasts` seconds.
struct SuddenRod {
  static constexpr double kTurning = 1.0;  // rad/s
  struct Moment {
    double time;    // s, of the step's end
    double torque;  // N·m on the rod
  };
  std::vector<Moment> moments;

  SuddenRod(double height, double lasts, const Setting& setting, Cost& cost) {
    SceneBuilder b;
    b.add_fluid(kDensity, kViscosity);
    const int glass = b.add_fixed("glass", glass_of(kOuter, height + 0.03, 0.02));
    constexpr double kGap = 0.012;  // under the rod, the same for every height
    const double top = height + 0.03;
    const int rod =
        b.add_free("rod", make::lathe({{0.0, kGap}, {kInner, kGap}, {kInner, top}, {0.0, top}}, 96), 0.5);
    b.set_viscosity({glass, rod}, kViscosity);
    b.add_volume(filling_of(kOuter, kGap));
    b.add_volume(make::lathe({{kInner, kGap}, {kOuter, kGap}, {kOuter, height}, {kInner, height}}, 96));
    b.scene.stiffness =
        kGravity * height / 0.04;  // the plan's rule for the whole depth, not for one volume's
    b.add_stiff_grip(rod);
    b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2});
    Trial e(b.scene, setting, cost);
    e.handle(0).engaged = true;
    e.settle(0.5, true);
    e.turn(rod, kTurning, lasts, [&](double time, double torque) { moments.push_back({time, torque}); });
  }
};

// m, of two fillings of each: what floor and foot do is in both.
constexpr double kShort = 0.06, kTall = 0.1;

std::vector<Reading> couette(const Setting& setting, Cost& cost) {
  constexpr double kR1 = kInner * kInner, kR2 = kOuter * kOuter;
  constexpr double kEven = 0.4;  // s; the gap's own time, (R₂ − R₁)²/(π²ν), is 40 ms
  const auto evenly = [&](double height) {
    Average torque;
    for (const SuddenRod::Moment& m : SuddenRod(height, 0.7, setting, cost).moments)
      if (m.time > kEven) torque.add(m.torque);
    return torque.mean();
  };
  const double low = evenly(kShort), high = evenly(kTall);
  const double expected =
      4.0 * kPi * kViscosity * SuddenRod::kTurning * kR1 * kR2 / (kR2 - kR1) * (kTall - kShort);
  return {{"torque", "N·m", high - low, expected, 0.0, true}};
}

// What a run's rod felt at `time`, s. A step's force is that at its start.
double torque_at(const std::vector<SuddenRod::Moment>& moments, double time) {
  double start = 0.0, last_start = 0.0, last = 0.0;
  for (const SuddenRod::Moment& now : moments) {
    if (start >= time) return glm::mix(last, now.torque, (time - last_start) / (start - last_start));
    last_start = start;
    start = now.time;
    last = now.torque;
  }
  return 0.0;
}

std::vector<Reading> couette_start(const Setting& setting, Cost& cost) {
  const SuddenRod low(kShort, 0.1, setting, cost), high(kTall, 0.1, setting, cost);
  RingFlow flow(kInner, kOuter, kViscosity, kDensity);
  constexpr double kStep = 1e-5;
  double time = 0.0;
  std::vector<Reading> readings;
  for (const int moment : {20, 40, 80}) {  // ms
    for (; time < 1e-3 * moment - 0.5 * kStep; time += kStep) flow.step(kStep, SuddenRod::kTurning, 0.0);
    readings.push_back({"torque at " + std::to_string(moment) + " ms", "N·m",
                        torque_at(high.moments, time) - torque_at(low.moments, time),
                        flow.inner_torque() * (kTall - kShort), 0.0, readings.empty()});
  }
  return readings;
}

// A ring-shaped trough turns faster and faster: in its frame the same force acts on all fluid along the gap,
// which has no ends. Poiseuille's flow, bent to a ring. Read is how far fluid stays behind, well above the
// floor, which drags at what is within a gap of it.
std::vector<Reading> poiseuille(const Setting& setting, Cost& cost) {
  constexpr double kGain = 10.0;  // rad/s²
  constexpr double kHeight = 0.1, kFrom = 0.05, kWall = 0.02, kTop = kHeight + 0.02;
  SceneBuilder b;
  b.add_fluid(kDensity, kViscosity);
  const make::Solid ring = make::lathe({{0.0, -kWall},
                                        {kOuter + kWall, -kWall},
                                        {kOuter + kWall, kTop},
                                        {kOuter, kTop},
                                        {kOuter, 0.0},
                                        {kInner, 0.0},
                                        {kInner, kTop},
                                        {0.0, kTop}},
                                       96);
  const int trough = b.add_free("trough", ring, 0.5);
  b.set_viscosity({trough}, kViscosity);
  b.add_volume(make::lathe({{kInner, 0.0}, {kOuter, 0.0}, {kOuter, kHeight}, {kInner, kHeight}}, 96));
  b.add_stiff_grip(trough);
  b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2});
  Trial e(b.scene, setting, cost);
  e.handle(0).engaged = true;
  e.settle(0.5, true);
  RingFlow flow(kInner, kOuter, kViscosity, kDensity);
  const double start = e.world().time();
  Snapshot before = e.picture();
  double last = start;
  Average starting, even;  // the share of Poiseuille's flow that there is
  e.run(0.25, [&] {
    const double time = e.world().time() - start, dt = e.world().time() - last;
    last = e.world().time();
    e.handle(0).twist.angular.y = kGain * time;
    e.handle(0).pose.orientation = glm::angleAxis(0.5 * kGain * time * time, kUp);
    const double turning = e.bodies().bodies[static_cast<std::size_t>(trough)].twist.angular.y;
    flow.step(dt, turning, turning);
    const Snapshot now = e.picture();
    Average* flows = time > 0.15 ? &even : time > 0.03 && time < 0.05 ? &starting : nullptr;
    if (flows != nullptr) {
      flows->add(share_of_shape(before, now, [&](std::size_t, const glm::dvec3& from, const glm::dvec3& to) {
        if (to.y < kFrom) return Along{};
        const double turned = std::atan2(from.z * to.x - from.x * to.z, from.x * to.x + from.z * to.z);
        const double radius = std::hypot(to.x, to.z);
        const double lag = radius * (turned / dt - turning),
                     expected = radius * (flow.turning_at(radius) - turning);
        return Along{{lag, 0.0}, {expected, 0.0}};
      }));
    }
    before = now;
  });
  return {{"flow", "", even.mean(), 1.0, 0.0, true}, {"flow at 40 ms", "", starting.mean(), 1.0, 0.0, false}};
}

// Fluid of 1 Pa·s in a vessel along whose walls and floor it slides, at rest under its own weight.
struct Still {
  Scene scene;
  SampledScene sampled;
};

Still at_rest(const make::Solid& vessel, const make::Solid& filling, const Setting& setting, Cost& cost) {
  SceneBuilder b;
  b.add_fluid(kDensity, kViscosity);
  b.set_viscosity({b.add_fixed("tank", vessel)}, kFreeSlip);
  b.add_volume(filling);
  b.set_domain({-0.15, -0.1, -0.15}, {0.15, 0.2, 0.15});
  SampledScene start = sampled_for(b.scene, setting);
  Trial settling(b.scene, start, setting, cost);
  settling.settle(1.0);
  start.fluid_positions = settling.picture().positions;
  return {std::move(b.scene), std::move(start)};
}

// It is given a horizontal flow that goes with `shape` (of x and z, at most 1): what is left of that at each
// moment, as a share.
using Shape = glm::dvec2 (*)(const glm::vec3& at);
std::vector<glm::dvec2> left_of(Shape shape, double speed, double seconds, Still still,
                                const Setting& setting, Cost& cost) {
  for (std::size_t i = 0; i < still.sampled.fluid_positions.size(); ++i) {
    const glm::dvec2 v = speed * shape(still.sampled.fluid_positions[i]);
    still.sampled.fluid_velocities[i] = {static_cast<float>(v.x), 0.0f, static_cast<float>(v.y)};
  }
  Trial e(still.scene, still.sampled, setting, cost, true);
  Snapshot before = e.picture();
  const double start = e.world().time();
  double last = start;
  std::vector<glm::dvec2> left;
  e.run(seconds, [&] {
    const Snapshot now = e.picture();
    const double dt = e.world().time() - last;
    last = e.world().time();
    const auto goes = [&](std::size_t, const glm::dvec3& from, const glm::dvec3& to) {
      return Along{{to.x - from.x, to.z - from.z}, shape(glm::vec3(0.5 * (to + from)))};
    };
    const double went = share_of_shape(before, now, goes);
    before = now;
    left.emplace_back(last - start, went / (dt * speed));
  });
  return left;
}

constexpr double kFast = 0.1, kSlow = 0.02;  // m/s

// Taylor and Green's vortex in a square tank: it meets no wall and no stress along one, keeps its shape and
// dies as exp(−2νk²t). A fluid that yields stops a slow one sooner.
std::vector<Reading> taylor_green(const Setting& setting, Cost& cost) {
  static constexpr double kSide = 0.08, kWave = kPi / kSide;
  constexpr double kHeight = 0.04, kHalf = 0.5 * kSide;
  constexpr double kRate = 2.0 * kViscosity / kDensity * kWave * kWave;
  const auto vortex = [](const glm::vec3& at) {
    const double x = kWave * (static_cast<double>(at.x) + kHalf),
                 z = kWave * (static_cast<double>(at.z) + kHalf);
    return glm::dvec2(std::sin(x) * std::cos(z), -std::cos(x) * std::sin(z));
  };
  const Still still = at_rest(tank_at_floor({kSide, kHeight + 0.04, kSide}, 0.03),
                              make::box({-kHalf, 0.0, -kHalf}, {kHalf, kHeight, kHalf}), setting, cost);
  const auto dies = [&](double speed) { return left_of(vortex, speed, 1.2 / kRate, still, setting, cost); };
  // The first tenth, in which pressures come about, is left out.
  std::vector<glm::dvec2> logs;
  for (const glm::dvec2& left : dies(kFast))
    if (left.x > 0.12 / kRate) logs.emplace_back(left.x, std::log(std::max(left.y, 1e-6)));
  double slow = 0.0;
  for (const glm::dvec2& left : dies(kSlow))
    if (left.x < 1.0 / kRate) slow = left.y;
  return {{"rate of decay", "1/s", -slope_of(logs), kRate, 0.0, true},
          {"left of 2 cm/s after a decay's time", "", slow, std::exp(-1.0), 0.0, false}};
}

// Nothing stops fluid that turns as one in a round glass without friction, but a wall that is not smooth.
std::vector<Reading> smooth_glass(const Setting& setting, Cost& cost) {
  static constexpr double kRadius = 0.05;
  constexpr double kHeight = 0.04;
  const auto turning = [](const glm::vec3& at) {
    return glm::dvec2(static_cast<double>(at.z), -static_cast<double>(at.x)) / kRadius;
  };
  const Still still =
      at_rest(glass_of(kRadius, kHeight + 0.04, 0.03), filling_of(kRadius, kHeight), setting, cost);
  const auto kept = [&](double speed) { return left_of(turning, speed, 0.4, still, setting, cost).back().y; };
  return {{"kept, 10 cm/s at the rim", "", kept(kFast), 1.0, 0.0, true},
          {"kept, 2 cm/s at the rim", "", kept(kSlow), 1.0, 0.0, false}};
}

}  // namespace

std::vector<ErrorCase> plane_flow_cases() {
  return {
      {"couette",
       "Torque between cylinders of 30 and 50 mm, 1 Pa·s",
       "4πμΩR₁²R₂²/(R₂²−R₁²)",
       {0.00667, 0.005, 0.004},
       1,
       couette},
      {"couette_start",
       "A rod suddenly turns in a gap of 20 mm, 1 Pa·s",
       "the gap's diffusion in r",
       {0.00667, 0.005, 0.004},
       1,
       couette_start},
      {"poiseuille",
       "Fluid lags in a ring that turns faster and faster",
       "Poiseuille's flow in a ring",
       {0.00667, 0.005, 0.004},
       1,
       poiseuille},
      {"taylor_green",
       "A vortex dies in a tank without friction, 1 Pa·s",
       "exp(−2νk²t)",
       {0.01, 0.008, 0.005},
       1,
       taylor_green},
      {"smooth_glass",
       "Fluid turns in a glass without friction",
       "it keeps on",
       {0.01, 0.008, 0.005},
       1,
       smooth_glass},
  };
}

}  // namespace slosh::report
