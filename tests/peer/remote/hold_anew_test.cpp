// A body between a host and hands that come back elsewhere than they went: how hard it pulls. The host's own
// hands, gate and world, and a device loop a person, on a clock that the test moves; messages are handed over
// where the wire would.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "held_beam.h"
#include "net/grip_start.h"
#include "tests/peer/servo_kit.h"

namespace slosh {
namespace {

using test::held_beam;
using test::HostEnd;
using test::kMass;
using test::kShare;
using test::sample_of;
using test::world_at_rest;
using test::world_of;

// The springs' ends go at kRampSpeed at most, gained over kRampRise and lost with the time constant kRampEnd:
// at most kRampSpeed / kRampEnd = 0.6 m/s² of the body, twice that when the springs swing with it. Half the
// body's mass hangs at each hand: 1.8 N. As much again for uneven engagement ramps.
constexpr double kRamp = 2.0 * 0.5 * kMass * 2.0 * kRampSpeed / kRampEnd;

/// One person at a grip of their own, with what reaches them.
struct HoldPerson {
  std::uint32_t grip;
  Channel channel;
  test::FakeDevice* device = nullptr;
  std::unique_ptr<Servo> servo;
  std::uint64_t number = 0;
  bool in_contact = true;

  HoldPerson(const Scene& scene, std::uint32_t at, const BodyMessage& first)
      : grip(at), channel(scene.grips.size(), first, 1000) {
    std::vector<std::unique_ptr<Device>> devices(scene.grips.size());
    auto made = std::make_unique<test::FakeDevice>();
    device = made.get();
    device->next.pose = grip_start(scene, at);
    devices[at] = std::move(made);
    servo = std::make_unique<Servo>(scene, std::move(devices), channel, ServoOptions{});
  }
};

class HoldAnew : public ::testing::Test {
 protected:
  Scene scene = held_beam();
  std::unique_ptr<HostEnd> host;
  std::vector<std::unique_ptr<HoldPerson>> people;
  std::int64_t clock = to_nanoseconds(1000.0);
  double dt = 0.0;
  double felt = 0.0;     // N, the most that anybody felt
  double carried = 0.0;  // N, the most between the body and a hand

  void SetUp() override {
    host = std::make_unique<HostEnd>(world_at_rest(scene), scene);
    dt = host->world.plan().time_step;
    host->hands.stand_all(clock);
    for (std::uint32_t i = 0; i < 2; ++i) {
      people.push_back(std::make_unique<HoldPerson>(scene, i, message()));
      host->hands.taken(i, clock);
    }
    run(2.0);
    EXPECT_NEAR(carried, kShare, 0.02 * kShare) << "settled: nothing happens when people take over";
    forget();
  }
  BodyMessage message() const {
    BodyMessage m;
    m.stamp_ns = clock;
    m.rate = 1.0;
    m.time_step = host->world.plan().time_step;
    m.bodies = host->now;
    return m;
  }
  void forget() { felt = carried = 0.0; }
  /// Wall time goes on, and the world with it while there is a host.
  void run(double seconds) {
    for (double left = seconds; left > 0.0; left -= dt) {
      clock += to_nanoseconds(dt);
      for (const auto& person : people) {
        person->servo->tick(clock - to_nanoseconds(0.5 * dt));
        person->servo->tick(clock);
        felt = std::max(felt, glm::length(person->device->last.force));
        if (host && person->in_contact) send(*person);
      }
      if (!host) continue;
      host->world.step(host->gate.take(host->channel, host->now, clock));
      host->world.fill(host->now);
      for (const GripState& grip : host->now.grips)
        carried = std::max(carried, glm::length(grip.on_hand.force));
      for (const auto& person : people) {
        if (!person->in_contact) continue;
        BodyMessage m = message();
        m.heard_pose_ns = host->hands.used(person->grip, host->gate.poses()[person->grip].number).stamp_ns;
        person->channel.bodies().back() = m;
        person->channel.bodies().publish();
      }
    }
  }
  void send(HoldPerson& person) {
    if (!person.channel.pose(person.grip).update()) return;  // PoseUplink sends what is new
    const PoseMessage& pose = person.channel.pose(person.grip).front();
    host->hands.sample(sample_of(pose, person.grip, ++person.number), clock);
  }
  void move_hands(const glm::dvec3& by) {
    for (const auto& person : people) person->device->next.pose.position += by;
  }
  double farthest() const {
    double most = 0.0;
    for (const auto& person : people)
      most = std::max(most, glm::distance(person->device->next.pose.position,
                                          host->now.grips[person->grip].pose.position));
    return most;
  }
  void print(const char* what) const {
    std::printf("%s: at most %.1f N on the body, %.1f N felt; at rest %.1f N; the springs alone %.0f N\n",
                what, carried, felt, kShare, 2000.0 * 0.3);
  }
};

TEST_F(HoldAnew, AfterACrashAndAResumeHandsThatMovedArePulledNoHarderThanTheyCarry) {
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(host->world.save(saved));
  run(0.4);  // lost in the crash
  host.reset();
  run(0.2);
  move_hands({0.0, 0.3, 0.0});
  run(2.0);

  World world = world_of(scene);
  ASSERT_TRUE(world.restore(saved));
  host = std::make_unique<HostEnd>(std::move(world), scene);
  host->hands.carry_on(host->now, clock);
  forget();
  for (const auto& person : people) person->in_contact = false;
  run(1.0);  // the host stands in until they are back
  EXPECT_LT(carried, 1.02 * kShare);
  for (const auto& person : people) {
    host->hands.taken(person->grip, clock);
    person->number = 0;
    person->in_contact = true;
  }
  run(6.0);
  print("crash and resume, hands 0.3 m higher");
  EXPECT_LT(carried, kShare + kRamp);
  EXPECT_LT(felt, kShare + kRamp);
  EXPECT_LT(farthest(), 0.02) << "in the end they hold it where they are";
}

TEST_F(HoldAnew, AHandThatComesBackWithinAMinuteIsPulledNoHarderThanItCarries) {
  HoldPerson& back = *people[0];
  back.in_contact = false;
  run(0.5);
  host->hands.let_go(back.grip, clock);
  back.device->next.pose.position.y += 0.3;
  for (int i = 0; i < 300; ++i) {  // the other one carries the beam up alone
    people[1]->device->next.pose.position.y += 0.001;
    run(0.01);
  }
  run(40.0);
  const double away = farthest();
  EXPECT_GT(away, 0.03) << "its end hangs down";
  forget();
  host->hands.taken(back.grip, clock);
  back.number = 0;
  back.in_contact = true;
  run(8.0);
  print("one hand back after 40 s");
  std::printf("it was %.0f mm away, %.0f N for the spring\n", 1e3 * away, 2000.0 * away);
  EXPECT_LT(carried, 2.0 * kShare + kRamp) << "what the other one carried alone";
  EXPECT_LT(felt, 2.0 * kShare + kRamp);
  EXPECT_LT(farthest(), 0.02);
}

TEST_F(HoldAnew, ASilenceOfAFewTenthsOfASecondIsNoBlow) {
  for (const auto& person : people) person->in_contact = false;
  run(0.3);
  move_hands({0.0, 0.3, 0.0});
  for (const auto& person : people) person->in_contact = true;
  run(0.01);
  forget();  // up to here a hand felt what was fading
  run(6.0);
  print("0.3 s of silence, hands 0.3 m higher");
  EXPECT_LT(carried, kShare + kRamp);
  EXPECT_LT(felt, kShare + kRamp);
  EXPECT_LT(farthest(), 0.02);
}

TEST_F(HoldAnew, WhoIsLeftAloneBeforeTheirHoldIsFirmCarriesItAll) {
  for (const auto& person : people) person->in_contact = false;
  run(0.3);
  move_hands({0.0, 0.1, 0.0});
  for (const auto& person : people) person->in_contact = true;
  run(0.3);
  HoldPerson& gone = *people[0];
  gone.device->next.engaged = false;  // lets go, of its own accord
  const double height = host->now.grips[1].pose.position.y;
  double lowest = height;
  for (int i = 0; i < 400; ++i) {
    run(0.01);
    lowest = std::min(lowest, host->now.grips[1].pose.position.y);
  }
  print("left alone 0.3 s after both re-engaged");
  std::printf("the grip sank by %.0f mm\n", 1e3 * (height - lowest));
  EXPECT_LT(height - lowest, 0.02);
  EXPECT_LT(glm::distance(people[1]->device->next.pose.position, host->now.grips[1].pose.position), 0.03)
      << "in the end it is held where the hand is";
}

TEST_F(HoldAnew, APauseIsNoBlowEither) {
  BodyMessage m = message();
  m.rate = 0.0;
  for (const auto& person : people) {
    person->channel.bodies().back() = m;
    person->channel.bodies().publish();
  }
  for (int i = 0; i < 1000; ++i) {
    clock += to_nanoseconds(0.001);
    if (i == 500) move_hands({0.0, 0.3, 0.0});
    for (const auto& person : people) {
      person->servo->tick(clock);
      send(*person);
    }
  }
  host->gate.stood_still();
  forget();
  run(6.0);
  print("a pause, hands 0.3 m higher");
  EXPECT_LT(carried, kShare + kRamp);
  EXPECT_LT(felt, kShare + kRamp);
  EXPECT_LT(farthest(), 0.02);
}

}  // namespace
}  // namespace slosh
