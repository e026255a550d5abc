// Two simulated operators at one beam over a long link: host, gate, world, poses' uplink, inboxes, device
// loops and replicas are the real ones, on a clock that the test moves; only the network between them is the
// test's own.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <functional>
#include <random>

#include "held_beam.h"
#include "host/server/body_parts.h"
#include "net/grip_start.h"
#include "peer/devices/operator_device.h"
#include "peer/haptics/servo.h"
#include "peer/remote/body_inbox.h"
#include "peer/remote/pose_uplink.h"

namespace slosh::test {

/// What the hand feels is noted.
class NotedOperator final : public Device {
 public:
  NotedOperator(PoseTrack track, const OperatorSettings& settings) : inner_(std::move(track), settings) {}
  DeviceReport read(const DeviceMoment& moment) override {
    DeviceReport report = inner_.read(moment);
    report.pose.position.y += nudge;
    return report;
  }
  void write(const Wrench& on_hand) override {
    inner_.write(on_hand);
    last = on_hand;
  }
  DeviceLimits limits() const override {
    DeviceLimits limits = inner_.limits();
    limits.max_force_rate = kForceRate;
    limits.max_damping = 100.0;
    if (!impedance) return limits;
    limits.max_force = 20.0;
    limits.max_stiffness = kStiffness;
    limits.max_damping = 30.0;
    limits.max_force_jerk = 2e5;
    limits.engagement_time = 2.0;
    return limits;
  }
  bool immediate() const override { return true; }
  bool goes_with_world() const override { return true; }
  std::string kind() const override { return "operator"; }
  Wrench last;
  double nudge = 0.0;                           // m, on top of where the arm is
  bool impedance = false;                       // its limits are a haptic arm's, and its force comes gently
  static constexpr double kStiffness = 1000.0;  // N/m, half the grip's
  static constexpr double kForceRate = 2000.0;  // N/s

 private:
  OperatorDevice inner_;
};

/// Bytes on their way, each late by its own.
struct Way {
  double delay = 0.0, jitter = 0.0, loss = 0.0;
  bool dark = false;
  std::deque<std::pair<std::int64_t, SharedBytes>> packets;
  void send(const SharedBytes& bytes, std::int64_t now_ns, std::mt19937_64& random) {
    std::uniform_real_distribution<> chance(0.0, 1.0);
    const double late = delay + jitter * chance(random);
    if (chance(random) < loss || dark) return;
    packets.emplace_back(now_ns + to_nanoseconds(late), bytes);
  }
  void deliver(std::int64_t now_ns, const std::function<void(wire::ByteView)>& take) {
    for (auto packet = packets.begin(); packet != packets.end();) {
      if (packet->first > now_ns) {
        ++packet;
        continue;
      }
      take(wire::ByteView(*packet->second).subspan(1));
      packet = packets.erase(packet);
    }
  }
};

struct DistantPerson {
  std::uint32_t grip;
  Channel channel;
  NotedOperator* device = nullptr;
  std::unique_ptr<Servo> servo;
  BodyInbox inbox;
  PoseUplink uplink;
  ClockSync clock;
  Way up, down;
  std::vector<bool> held;
  double peak = 0.0;  // N
  double step = 0.0;  // N from tick to tick
  double square = 0.0;
  int ticks = 0;

  DistantPerson(const Scene& scene, std::uint32_t at, const BodyMessage& first, double dt, PoseTrack track,
                Coupling coupling, bool impedance)
      : grip(at), channel(scene.grips.size(), first, 1000), inbox(scene, dt), uplink(channel) {
    std::vector<std::unique_ptr<Device>> devices(scene.grips.size());
    auto made = std::make_unique<NotedOperator>(std::move(track), OperatorSettings{});
    device = made.get();
    device->impedance = impedance;
    devices[at] = std::move(made);
    ServoOptions options;
    options.coupling = coupling;
    servo = std::make_unique<Servo>(scene, std::move(devices), channel, options);
    clock.add(0, 0, 0, 0);
    held.assign(scene.grips.size(), false);
    held[at] = true;
  }
};

class DistantPeople : public ::testing::Test {
 protected:
  Scene scene = held_beam();
  std::unique_ptr<HostEnd> host;
  std::unique_ptr<BodyParts> parts;
  std::vector<std::unique_ptr<DistantPerson>> people;
  std::mt19937_64 random{7};
  std::int64_t clock = to_nanoseconds(1000.0);
  std::int64_t step_ns = 0;
  double dt = 0.0;
  double rate = 1.0;
  std::uint32_t run_number = 0;
  int ticks = 0;
  wire::Capabilities agreed = wire::kOurCapabilities;

  /// 0.15 m up and 0.2 m to the side and back, in 6 s, from 3 s on.
  static PoseTrack carrying(const Pose& start) {
    std::vector<PoseKey> keys;
    for (const auto& [time, share] : {std::pair{3.0, 0.0}, {4.5, 1.0}, {6.0, 1.0}, {7.5, 0.0}}) {
      PoseKey& key = keys.emplace_back();
      key.time = time;
      key.pose = start;
      key.pose.position += share * glm::dvec3(0.2, 0.15, 0.0);
    }
    return PoseTrack(keys, start);
  }
  /// Where person `i` goes.
  std::function<PoseTrack(std::size_t, const Pose&)> way = [](std::size_t, const Pose& start) {
    return carrying(start);
  };
  /// `arm`: the first person's device is a haptic arm.
  void begin(double round_trip, double jitter, double loss, Coupling coupling, bool arm = false) {
    host = std::make_unique<HostEnd>(world_at_rest(scene), scene);
    parts = std::make_unique<BodyParts>(scene);
    dt = host->world.plan().time_step;
    host->hands.stand_all(clock);
    BodyMessage first;
    first.stamp_ns = clock;
    first.time_step = dt;
    first.bodies = host->now;
    first.heard_pose_ns = 0;  // far away
    for (std::uint32_t i = 0; i < 2; ++i) {
      people.push_back(std::make_unique<DistantPerson>(scene, i, first, dt, way(i, grip_start(scene, i)),
                                                       coupling, arm && i == 0));
      people.back()->inbox.set_stands_until_felt((agreed & wire::kFeltHands) != 0);
      people.back()->up.delay = people.back()->down.delay = 0.5 * round_trip;
      people.back()->up.jitter = people.back()->down.jitter = jitter;
      people.back()->up.loss = people.back()->down.loss = loss;
      host->hands.taken(i, clock);
    }
    step_ns = clock;
  }
  void run(double seconds) {
    for (int left = static_cast<int>(seconds / 0.001 + 0.5); left > 0; --left) {
      clock += 1'000'000;
      ticks += 1;
      for (const auto& person : people) {
        person->up.deliver(clock, [&](wire::ByteView bytes) {
          wire::Poses poses;
          ASSERT_FALSE(wire::decode(bytes, poses, wire::kOurCapabilities));
          for (auto sample = poses.samples.rbegin(); sample != poses.samples.rend(); ++sample)
            host->hands.sample(*sample, clock, true);
        });
      }
      step_host();
      for (const auto& person : people) turn(*person);
    }
  }
  void step_host() {
    while (step_ns <= clock) {
      step_ns += to_nanoseconds(dt);
      const auto inputs = host->gate.take(host->channel, host->now, clock);
      if (rate > 0.0) host->world.step(inputs);
      host->world.fill(host->now);
      BodyMessage message;
      message.run = run_number;
      message.stamp_ns = step_ns;
      message.rate = rate;
      message.time_step = dt;
      message.bodies = host->now;
      std::vector<std::uint64_t> numbers;
      for (std::size_t g = 0; g < 2; ++g) {
        const PoseMessage& used = host->gate.poses()[g];
        message.hands.push_back({used.number, used.stamp_ns, used.time, used.counted, used.energy});
        numbers.push_back(host->hands.used(g, used.number).number);
      }
      parts->set(message, numbers);
      for (const auto& person : people) {
        const HandTable::Used used = host->hands.used(person->grip, host->gate.poses()[person->grip].number);
        for (const SharedBytes& bytes : parts->to(used.number, used.stamp_ns))
          person->down.send(bytes, clock, random);
      }
    }
  }
  void turn(DistantPerson& person) {
    person.down.deliver(clock, [&](wire::ByteView bytes) {
      wire::Bodies bodies;
      ASSERT_FALSE(wire::decode(bytes, bodies, wire::kOurCapabilities));
      person.inbox.take(bodies, clock, person.clock);
      if (const BodyMessage* newest = person.inbox.newest()) {
        person.channel.newest().back() = *newest;
        person.uplink.resolve(person.channel.newest().back(), person.held);
        person.channel.newest().publish();
      }
    });
    if (const BodyMessage* state = person.inbox.next(clock, person.clock)) {
      person.channel.bodies().back() = *state;
      person.channel.bodies().publish();
    }
    const glm::dvec3 before = person.device->last.force;
    person.servo->tick(clock);
    const glm::dvec3 force = person.device->last.force;
    person.peak = std::max(person.peak, glm::length(force));
    person.step = std::max(person.step, glm::length(force - before));
    const glm::dvec3 off = force - glm::dvec3(0.0, -kShare, 0.0);
    person.square += glm::dot(off, off);
    person.ticks += 1;
    if (ticks % 2 == 0) {
      if (SharedBytes poses = person.uplink.make(person.held, agreed)) person.up.send(poses, clock, random);
    }
  }
  void forget() {
    for (const auto& person : people) person->peak = person->step = person->square = person->ticks = 0;
  }
  double peak() const { return std::max(people[0]->peak, people[1]->peak); }
  double step() const { return std::max(people[0]->step, people[1]->step); }
  /// N rms off the share of the weight, worst of both.
  double off() const {
    double most = 0.0;
    for (const auto& p : people) most = std::max(most, std::sqrt(p->square / std::max(p->ticks, 1)));
    return most;
  }
  void print(const char* what) const {
    std::printf("%-44s peak %6.1f N, off the share %5.2f N rms, most from tick to tick %.2f N\n", what,
                peak(), off(), step());
  }
};

}  // namespace slosh::test
