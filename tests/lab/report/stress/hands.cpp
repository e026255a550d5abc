// Stiff, fast and many hands, and closed vessels that they shake.
#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/math/format.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/stress/scenes.h"
#include "tests/lab/report/surface.h"
#include "tests/lab/report/watch.h"

namespace slosh::report {
namespace {

Stress moved(const Scene& scene, double seconds, const std::function<void(Trial&)>& hand, double farthest,
             double most_lost, const Setting& setting, Cost& cost) {
  Trial t(scene, setting, cost);
  for (std::size_t g = 0; g < t.grips(); ++g) t.handle(g).engaged = true;
  Watch watch(t, scene);
  double far = 0.0;
  watch.run(seconds, [&] {
    far = std::max(far, glm::distance(t.bodies().grips[0].pose.position, t.handle(0).pose.position));
    hand(t);
  });
  Stress found = watch.found(most_lost);
  if (!(far <= farthest)) found.broken = format("the grip was %.2g mm from its hand", 1e3 * far);
  return found;
}

Stress stiff(const Setting& setting, Cost& cost) {
  const auto hand = [](Trial& t) {
    const double rate = 6.0 * kPi, angle = rate * t.world().time();
    t.handle(0).pose.position.y = kHeldBox.y + 0.02 * std::sin(angle);
    t.handle(0).twist.linear.y = 0.02 * rate * std::cos(angle);
  };
  return moved(held_box(0.02, 1e6, 100.0, 1), 1.0, hand, 2e-3, 0.0, setting, cost);
}

Stress sixteen(const Setting& setting, Cost& cost) {
  return moved(
      held_box(0.3, 1e4, 50.0, 16), 1.0, [](Trial&) {}, 5e-3, 0.0, setting, cost);
}

// To 20 m/s within 20 ms, back and forth through the fluid and 25 cm of air.
Stress fast(const Setting& setting, Cost& cost) {
  double speed = 0.0;
  bool down = true;
  const auto hand = [&](Trial& t) {
    const double dt = t.world().plan().time_step;
    double& y = t.handle(0).pose.position.y;
    speed += std::clamp((down ? -20.0 : 20.0) - speed, -1000.0 * dt, 1000.0 * dt);
    y += speed * dt;
    if (y < 0.03) down = false;
    if (y > 0.30) down = true;
    t.handle(0).twist.linear.y = speed;
  };
  return moved(held_box(0.1, 1e5, 200.0, 1), 0.5, hand, 0.3, 0.0, setting, cost);
}

// A hand that is suddenly 0.3 m away, with nothing between (the host's gate would let it in slowly).
Stress jump(const Setting& setting, Cost& cost) {
  const auto hand = [](Trial& t) {
    if (t.world().time() > 0.3) t.handle(0).pose.position.y = kHeldBox.y + 0.3;
  };
  return moved(held_box(0.2, 2000.0, 20.0, 1), 1.0, hand, 0.31, 0.0, setting, cost);
}

// A closed box with walls of 1.5 spacings, a third full, moved along x by `way` (m at a time). What is found
// outside has passed a wall.
Stress vessel(double seconds, const std::function<glm::dvec2(double)>& way_and_speed, const Setting& setting,
              Cost& cost) {
  constexpr double kHalf = 0.05;
  const double wall = 1.5 * setting.spacing;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  make::Solid shell = make::box(glm::dvec3(-kHalf - wall), glm::dvec3(kHalf + wall));
  // The hollow is the same box seen from inside.
  make::Solid hollow = make::box(glm::dvec3(-kHalf), glm::dvec3(kHalf));
  for (glm::uvec3& t : hollow.triangles) std::swap(t.y, t.z);
  const int box = b.add_free("vessel", make::merged(shell, hollow), 0.5);
  b.add_volume(make::box(glm::dvec3(-kHalf), {kHalf, -kHalf / 3.0, kHalf}));
  b.add_grip(box, 1e5, 500.0, 1e3, 10.0);
  b.set_domain(glm::dvec3(-1.0), glm::dvec3(1.0));
  Trial t(b.scene, setting, cost);
  t.handle(0).engaged = true;
  t.settle(0.5, true);
  Watch watch(t, b.scene);
  watch.run(seconds, [&] {
    const glm::dvec2 now = way_and_speed(t.world().time());
    t.handle(0).pose.position.x = now.x;
    t.handle(0).twist.linear.x = now.y;
  });
  Stress found = watch.found();
  const glm::dvec3 within(kHalf + 0.8 * setting.spacing);
  found.lost_share =
      share_outside(t.picture(), t.bodies().bodies[static_cast<std::size_t>(box)].pose, {-within, within});
  return found;
}

template <int kCentimetresPerSecond, int kSeconds>
Stress shaken(const Setting& setting, Cost& cost) {
  constexpr double kFrequency = 3.0, kRate = 2.0 * kPi * kFrequency,
                   kWay = 0.01 * kCentimetresPerSecond / kRate;
  return vessel(
      kSeconds,
      [](double t) {
        return glm::dvec2(kWay * (1.0 - std::cos(kRate * t)), kWay * kRate * std::sin(kRate * t));
      },
      setting, cost);
}

// 14 g for 15 ms, then at rest again at once.
Stress jerk(const Setting& setting, Cost& cost) {
  constexpr double kAcceleration = 14.0 * kGravity, kFor = 0.015;
  return vessel(
      1.0,
      [](double t) {
        const double u = std::clamp(t - 0.1, 0.0, 2.0 * kFor);
        if (u <= kFor) return glm::dvec2(0.5 * kAcceleration * u * u, u < kFor ? kAcceleration * u : 0.0);
        const double rest = 2.0 * kFor - u;
        return glm::dvec2(kAcceleration * (kFor * kFor - 0.5 * rest * rest), kAcceleration * rest);
      },
      setting, cost);
}

}  // namespace

std::vector<StressCase> hand_stress() {
  return {
      {"stiff", "A million N/m on 20 g", 0.01, true, true, stiff},
      {"sixteen", "Sixteen hands on one body", 0.01, true, true, sixteen},
      {"fast", "A hand at 20 m/s", 0.01, true, true, fast},
      {"jump", "A hand that is suddenly 0.3 m away", 0.01, true, true, jump},
      {"shaken_60", "A closed vessel shaken at 0.6 m/s", 0.01, true, true, shaken<60, 3>},
      {"shaken_125", "A closed vessel shaken at 1.25 m/s", 0.01, true, true, shaken<125, 3>},
      {"shaken_250", "A closed vessel shaken at 2.5 m/s", 0.01, true, true, shaken<250, 3>},
      {"jerk", "A closed vessel jerked with 14 g", 0.01, true, true, jerk},
  };
}

}  // namespace slosh::report
