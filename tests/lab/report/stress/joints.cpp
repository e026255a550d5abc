// Linkages: long, of unlike masses, pulled at by stiff hands, in thick fluid.
#include <algorithm>
#include <cmath>

#include "sim/math/format.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/stress/scenes.h"
#include "tests/lab/report/watch.h"

namespace slosh::report {
namespace {

constexpr double kLink = 0.08;    // m between hinges
constexpr double kMaxGap = 1e-3;  // m in a hinge

// A hinge about z; the file's pose of the body has no rotation but `turn`.
void hinge(Scene& scene, int body, int other, const glm::dvec3& at) {
  Joint joint;
  joint.name = "hinge";
  joint.body = body;
  joint.other = other;
  const Pose frame{at, glm::angleAxis(0.5 * kPi, glm::dvec3(1, 0, 0))};  // its y along z
  joint.pose = compose(inverse(scene.bodies[static_cast<std::size_t>(body)].pose), frame);
  scene.joints.push_back(joint);
}

// Ten links that start out level from the world; the last weighs `heavier` times the others.
Scene chain(double heavier) {
  SceneBuilder b;
  int above = -1;
  for (int i = 0; i < 10; ++i) {
    const double mass = i == 9 ? 0.02 * heavier : 0.02;
    const int link =
        b.add_free("link", make::box({-0.4 * kLink, -0.005, -0.005}, {0.4 * kLink, 0.005, 0.005}), mass,
                   {{(i + 0.5) * kLink, 0.0, 0.0}, {1, 0, 0, 0}});
    hinge(b.scene, link, above, {i * kLink, 0.0, 0.0});
    above = link;
  }
  b.set_domain(glm::dvec3(-3.0), glm::dvec3(3.0));
  return b.scene;
}

// It falls, whips and sways: no hinge opens, and it never has more energy than it began with.
Stress swings(const Scene& scene, double seconds, const Setting& setting, Cost& cost) {
  Trial t(scene, setting, cost);
  double gap = 0.0, most = 0.0, whole = 0.0;
  for (const Body& body : scene.bodies) whole += body.mass.mass * kGravity * body.pose.position.x;
  t.run(seconds, [&] {
    double energy = 0.0;
    glm::dvec3 end(0.0);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const MassProperties& mass = scene.bodies[i].mass;
      const BodyState& link = t.bodies().bodies[i];
      const glm::dvec3 turning = glm::conjugate(link.pose.orientation) * link.twist.angular;
      energy += 0.5 * mass.mass * glm::dot(link.twist.linear, link.twist.linear) +
                0.5 * glm::dot(turning, mass.inertia * turning) +
                mass.mass * kGravity * link.center_of_mass.y;
      gap = std::max(gap, glm::distance(end, transform_point(link.pose, {-0.5 * kLink, 0.0, 0.0})));
      end = transform_point(link.pose, {0.5 * kLink, 0.0, 0.0});
    }
    most = std::max(most, energy / whole);
  });
  Stress found;
  found.finite = all_finite(t.world());
  if (!(gap < kMaxGap)) found.broken = format("a hinge is open by %.2g mm", 1e3 * gap);
  // Velocities are half a step behind places.
  if (!(most < 0.25)) found.broken = format("it has %.2g times its fall more than it began with", most);
  return found;
}

Stress whip(const Setting& setting, Cost& cost) {
  return swings(chain(1.0), 10.0, setting, cost);
}
Stress light_end(const Setting& setting, Cost& cost) {
  return swings(chain(1e-3), 5.0, setting, cost);
}
Stress heavy_end(const Setting& setting, Cost& cost) {
  return swings(chain(1e3), 5.0, setting, cost);
}

// A door in a hand of 10⁶ N/m that goes round with it, and then pulls it off its hinge.
Stress stiff_door(const Setting& setting, Cost& cost) {
  SceneBuilder b;
  const int door = b.add_free("door", make::box({-0.1, -0.1, -0.005}, {0.1, 0.1, 0.005}), 0.5,
                              {{0.1, 0.0, 0.0}, {1, 0, 0, 0}});
  hinge(b.scene, door, -1, {0.0, 0.0, 0.0});
  b.add_grip(door, 1e6, 100.0, 0.0, 0.0, {{0.1, 0.0, 0.0}, {1, 0, 0, 0}});
  b.set_domain(glm::dvec3(-1.0), glm::dvec3(1.0));
  Trial t(b.scene, setting, cost);
  t.handle(0).engaged = true;
  double gap = 0.0, fastest = 0.0;
  const auto look = [&] {
    const BodyState& state = t.bodies().bodies[static_cast<std::size_t>(door)];
    gap = std::max(gap, glm::length(transform_point(state.pose, {-0.1, 0.0, 0.0})));
    fastest = std::max(fastest, glm::length(state.twist.angular));
  };
  t.run(1.0, [&] {
    const double angle = 4.0 * t.world().time();
    t.handle(0).pose.position = {0.2 * std::cos(angle), 0.2 * std::sin(angle), 0.0};
    t.handle(0).twist.linear = {-0.8 * std::sin(angle), 0.8 * std::cos(angle), 0.0};
    look();
  });
  t.handle(0).twist = {};
  t.handle(0).pose.position *= 1.5;
  t.run(1.0, look);
  Stress found;
  found.finite = all_finite(t.world());
  if (!(gap < kMaxGap)) found.broken = format("the hinge is open by %.2g mm", 1e3 * gap);
  if (!(fastest < 20.0)) found.broken = format("the door turned at %.2g rad/s", fastest);
  return found;
}

// Ten links fixed to each other that stand out from a wall, the last of a thousand times their mass.
Scene beam(double heavier, double breaks) {
  SceneBuilder b;
  int above = -1;
  for (int i = 0; i < 10; ++i) {
    const int link =
        b.add_free("link", make::box({-0.4 * kLink, -0.005, -0.005}, {0.4 * kLink, 0.005, 0.005}),
                   i == 9 ? 0.02 * heavier : 0.02, {{(i + 0.5) * kLink, 0.0, 0.0}, {1, 0, 0, 0}});
    Joint joint;
    joint.name = "weld";
    joint.kind = JointKind::kFixed;
    joint.body = link;
    joint.other = above;
    joint.pose.position = {-0.5 * kLink, 0.0, 0.0};
    joint.breaks_force = breaks;
    b.scene.joints.push_back(joint);
    above = link;
  }
  b.set_domain(glm::dvec3(-3.0), glm::dvec3(3.0));
  return b.scene;
}

Stress stiff_beam(const Setting& setting, Cost& cost) {
  const Scene scene = beam(1e3, 0.0);
  Trial t(scene, setting, cost);
  double sag = 0.0;
  t.run(5.0, [&] {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      sag = std::max(sag, glm::distance(t.bodies().bodies[i].pose.position, scene.bodies[i].pose.position));
  });
  Stress found;
  found.finite = all_finite(t.world());
  if (!(sag < kMaxGap)) found.broken = format("it sags by %.2g mm", 1e3 * sag);
  return found;
}

// A hand of 10⁶ N/m jerks at its end until all of it is in pieces: each goes on no faster than the hand went.
Stress torn_beam(const Setting& setting, Cost& cost) {
  constexpr double kFastest = 3.0;  // m/s, of the hand
  SceneBuilder b;
  b.scene = beam(1.0, 50.0);
  b.add_grip(9, 1e6, 100.0, 0.0, 0.0, {{0.0, 0.0, 0.0}, {1, 0, 0, 0}});
  Trial t(b.scene, setting, cost);
  t.handle(0).engaged = true;
  t.run(0.1);
  const glm::dvec3 start = t.handle(0).pose.position;
  double fastest = 0.0, beyond = 0.0;
  t.run(1.0, [&] {
    const double time = t.world().time() - 0.1, way = 0.1, turning = kFastest / way;
    t.handle(0).pose.position =
        start + glm::dvec3(way * std::sin(turning * time), way * std::sin(2.7 * turning * time) / 2.7, 0.0);
    t.handle(0).twist.linear =
        kFastest * glm::dvec3(std::cos(turning * time), std::cos(2.7 * turning * time), 0.0);
    for (const BodyState& link : t.bodies().bodies)
      fastest = std::max(fastest, glm::length(link.twist.linear));
    for (const JointState& joint : t.bodies().joints)
      if (joint.joined) beyond = std::max(beyond, glm::length(joint.reaction.force));
  });
  Stress found;
  found.finite = all_finite(t.world());
  const auto& joints = t.bodies().joints;
  if (std::all_of(joints.begin(), joints.end(), [](const JointState& joint) { return joint.joined; }))
    found.broken = "nothing broke";
  if (beyond > 50.0) found.broken = format("a joint that holds bore %.3g N", beyond);
  // A free link in a light blow may leave with twice the speed of what hit it, and falls beside that.
  if (!(fastest < 25.0)) found.broken = format("a link flew at %.2g m/s", fastest);
  return found;
}

// A blade of a tenth of the fluid's density on a hinge with a motor, in honey.
Stress stirred_honey(const Setting& setting, Cost& cost) {
  SceneBuilder b;
  b.add_fluid(1400.0, 10.0);
  const int tank = b.add_fixed("tank", tank_at_floor({0.16, 0.2, 0.16}, 0.03));
  const int blade = b.add_free("blade", make::box({-0.05, -0.03, -0.008}, {0.05, 0.03, 0.008}), 0.01,
                               {{0.0, 0.06, 0.0}, {1, 0, 0, 0}});
  b.set_viscosity({tank, blade}, kFluidsViscosity);
  b.add_volume(make::box({-0.08, 0.0, -0.08}, {0.08, 0.12, 0.08}));
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 1.0, 0.4});
  Joint joint;
  joint.name = "shaft";
  joint.body = blade;
  joint.motor_speed = 5.0;
  joint.motor_limit = 50.0;
  b.scene.joints.push_back(joint);
  Trial t(b.scene, setting, cost);
  Watch watch(t, b.scene);
  double gap = 0.0, fastest = 0.0;
  watch.run(1.0, [&] {
    const BodyState& state = t.bodies().bodies[static_cast<std::size_t>(blade)];
    gap = std::max(gap, glm::distance(state.pose.position, glm::dvec3(0.0, 0.06, 0.0)));
    fastest = std::max(fastest, std::abs(state.twist.angular.y));
  });
  Stress found = watch.found();
  if (!(gap < kMaxGap)) found.broken = format("the hinge is open by %.2g mm", 1e3 * gap);
  if (!(fastest < 5.5)) found.broken = format("the blade turned at %.2g rad/s", fastest);
  return found;
}

}  // namespace

std::vector<StressCase> joint_stress() {
  return {
      {"whip", "Ten links on hinges that whip", 0.01, true, false, whip},
      {"light_end", "The last of a thousandth of the others' mass", 0.01, true, false, light_end},
      {"heavy_end", "The last of a thousand times the others' mass", 0.01, true, false, heavy_end},
      {"stiff_beam", "Ten links fixed to each other, a thousand times their mass at the end", 0.01, true,
       false, stiff_beam},
      {"torn_beam", "Ten links fixed to each other, torn apart by a jerk", 0.01, true, false, torn_beam},
      {"stiff_door", "A hinged door in a hand of 10⁶ N/m", 0.01, true, false, stiff_door},
      {"stirred_honey", "A light blade on a motor in honey", 0.01, true, true, stirred_honey},
  };
}

}  // namespace slosh::report
