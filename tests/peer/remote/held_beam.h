// A beam that two hands hold high, and the host's end of it: world, gate and hands on a clock that the test
// moves.
#pragma once

#include "host/input_gate.h"
#include "host/server/hands.h"
#include "net/channel.h"
#include "net/grip_start.h"
#include "tests/physics/lab.h"

namespace slosh::test {

constexpr double kMass = 3.0;                           // kg
constexpr double kShare = 0.5 * kMass * lab::kGravity;  // N, what each of two hands carries at rest
constexpr double kSpacing = 0.02;                       // m

/// A beam held high over a little fluid by two grips as stiff as the bucket's.
inline Scene held_beam() {
  lab::SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("tank", lab::tank_at_floor({0.16, 0.16, 0.16}, 0.03));
  const int beam = b.add_free("beam", make::box({-0.15, -0.02, -0.02}, {0.15, 0.02, 0.02}), kMass,
                              {{0.0, 1.0, 0.0}, {1, 0, 0, 0}});
  b.add_volume(make::box({-0.08, 0.0, -0.08}, {0.08, 0.04, 0.08}));
  for (const double x : {-0.15, 0.15}) b.add_grip(beam, 2000.0, 60.0, 20.0, 0.6, {{x, 0, 0}, {1, 0, 0, 0}});
  b.set_domain({-1.0, -0.5, -1.0}, {1.0, 2.0, 1.0});
  return b.scene;
}

inline World world_of(const Scene& scene) {
  return World(scene, sample_scene(scene, kSpacing).value(), make_plan(scene, kSpacing),
               WorldOptions{1, Backend::kCpu});
}

/// It hangs at rest in stands at its grips.
inline World world_at_rest(const Scene& scene) {
  World world = world_of(scene);
  std::vector<HandleInput> stands;
  for (std::size_t i = 0; i < scene.grips.size(); ++i)
    stands.push_back({grip_start(scene, i), Twist{}, true, 1.0});
  world.settle(1.0, stands);
  return world;
}

/// A device's pose as the wire has it.
inline wire::PoseSample sample_of(const PoseMessage& pose, std::uint32_t grip, std::uint64_t number) {
  wire::PoseSample sample;
  sample.grip = grip;
  sample.number = number;
  sample.stamp_ns = pose.stamp_ns;
  sample.time = pose.time;
  sample.pose = pose.pose;
  sample.twist = pose.twist;
  sample.engaged = pose.engaged ? wire::HoldsOn::kYes : wire::HoldsOn::kNo;
  return sample;
}

/// What dies in a crash.
struct HostEnd {
  World world;
  Channel channel;
  InputGate gate;
  HandTable hands;
  BodySnapshot now;
  HostEnd(World made, const Scene& scene)
      : world(std::move(made)),
        channel(scene.grips.size(), BodyMessage{}, 1000),
        gate(scene),
        hands(scene, channel) {
    world.fill(now);
  }
};

}  // namespace slosh::test
