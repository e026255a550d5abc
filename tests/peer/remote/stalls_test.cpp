// Processes that stand still while hands carry a beam: what hands feel and how the beam moves, beside the
// same people undisturbed. The host's own hands, gate and world, and a device loop a person, on a clock that
// the test moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <random>

#include "held_beam.h"
#include "net/grip_start.h"
#include "tests/peer/servo_kit.h"

namespace slosh {
namespace {

using test::held_beam;
using test::HostEnd;
using test::sample_of;
using test::world_at_rest;

constexpr double kFactor = 1.5;  // times what an undisturbed run has
constexpr double kSwing = 0.2;   // m that the hands go to and fro

/// What a run came to, at most.
struct Worst {
  double force = 0.0, torque = 0.0, change = 0.0;  // of any hand: N, N·m, N a millisecond
  double rise = 0.0, way = 0.0;                    // of the beam: m
  double speed = 0.0, spin = 0.0;                  // m/s, rad/s
};

struct StalledPerson {
  std::uint32_t grip;
  Channel channel;
  test::FakeDevice* device = nullptr;
  std::unique_ptr<Servo> servo;
  std::uint64_t number = 0;
  double stopped_until = 0.0;  // s
  bool holds = true;
  Wrench before;

  StalledPerson(const Scene& scene, std::uint32_t at, const BodyMessage& first, bool feels)
      : grip(at), channel(scene.grips.size(), first, 1000) {
    std::vector<std::unique_ptr<Device>> devices(scene.grips.size());
    auto made = std::make_unique<test::FakeDevice>();
    made->feels = feels;
    device = made.get();
    device->next.pose = grip_start(scene, at);
    devices[at] = std::move(made);
    servo = std::make_unique<Servo>(scene, std::move(devices), channel, ServoOptions{});
  }
};

/// A run of one or two people who move the beam to and fro, with a disturbance each tick.
class Carrying {
 public:
  Carrying(std::size_t people, bool feels) {
    host_.hands.stand_all(clock_);
    for (std::uint32_t i = 0; i < people; ++i) {
      people_.push_back(std::make_unique<StalledPerson>(scene_, i, message(), feels));
      host_.hands.taken(i, clock_);
    }
    start_ = host_.now.bodies[kBeam];
  }

  double host_stopped_until = 0.0;  // s
  void stop(std::size_t person, double until) { people_[person]->stopped_until = until; }
  HostEnd& host() { return host_; }
  void let_go(std::size_t person) {
    people_[person]->holds = false;
    host_.hands.let_go(people_[person]->grip, clock_);
  }
  void take(std::size_t person) {
    people_[person]->holds = true;
    people_[person]->number = 0;
    host_.hands.taken(people_[person]->grip, clock_);
  }

  Worst run(double seconds, const std::function<void(Carrying&, double)>& disturb) {
    for (double t = 0.0; t < seconds; t += 0.001) {
      clock_ += 1'000'000;
      disturb(*this, t);
      const double x = 0.5 * kSwing * (1.0 - std::cos(4.0 * t)), v = 2.0 * kSwing * std::sin(4.0 * t);
      for (const auto& person : people_) {
        const Pose at = grip_start(scene_, person->grip);
        person->device->next.pose.position = at.position + glm::dvec3(0.0, 0.5 * x, x);
        person->device->next.twist.linear = {0.0, 0.5 * v, v};
        person->device->next.engaged = person->holds;
        if (t < person->stopped_until) continue;
        person->servo->tick(clock_);
        note(*person, t);
        if (person->channel.pose(person->grip).update() && person->holds) {
          sent_.push_back({person->grip, sample_of(person->channel.pose(person->grip).front(), person->grip,
                                                   ++person->number)});
        }
      }
      if (t < host_stopped_until) continue;
      for (const auto& [grip, sample] : sent_) host_.hands.sample(sample, clock_, true);
      sent_.clear();
      while (step_ns_ <= clock_) step();
    }
    return worst_;
  }

 private:
  static constexpr std::size_t kBeam = 1;

  BodyMessage message() const {
    BodyMessage m;
    m.stamp_ns = clock_;
    m.rate = 1.0;
    m.time_step = host_.world.plan().time_step;
    m.bodies = host_.now;
    for (std::size_t i = 0; i < scene_.grips.size(); ++i)
      m.hands.push_back({.stand = host_.gate.poses()[i].stand});
    return m;
  }
  void step() {
    step_ns_ = std::max(step_ns_ + to_nanoseconds(host_.world.plan().time_step), clock_ - 50'000'000);
    host_.world.step(host_.gate.take(host_.channel, host_.now, clock_));
    host_.world.fill(host_.now);
    for (const auto& person : people_) {
      BodyMessage m = message();
      m.heard_pose_ns = host_.hands.used(person->grip, host_.gate.poses()[person->grip].number).stamp_ns;
      person->channel.bodies().back() = m;
      person->channel.bodies().publish();
    }
    const BodyState& beam = host_.now.bodies[kBeam];
    worst_.rise = std::max(worst_.rise, beam.center_of_mass.y - start_.center_of_mass.y);
    worst_.way = std::max(worst_.way, glm::distance(beam.center_of_mass, start_.center_of_mass));
    worst_.speed = std::max(worst_.speed, glm::length(beam.twist.linear));
    worst_.spin = std::max(worst_.spin, glm::length(beam.twist.angular));
  }
  void note(StalledPerson& person, double t) {
    const Wrench now = person.device->last;
    worst_.force = std::max(worst_.force, glm::length(now.force));
    worst_.torque = std::max(worst_.torque, glm::length(now.torque));
    if (t > 0.5) worst_.change = std::max(worst_.change, glm::length(now.force - person.before.force));
    person.before = now;
  }

  Scene scene_ = held_beam();
  HostEnd host_{world_at_rest(scene_), scene_};
  std::int64_t clock_ = to_nanoseconds(1000.0);
  std::int64_t step_ns_ = clock_;
  std::vector<std::unique_ptr<StalledPerson>> people_;
  std::vector<std::pair<std::uint32_t, wire::PoseSample>> sent_;
  BodyState start_;
  Worst worst_;
};

void expect_within(const Worst& run, const Worst& control, const std::string& what) {
  std::printf(
      "%-40s %5.1f (%.1f) N, %.2f (%.2f) N·m, %.1f N/ms; %.2f (%.2f) m up, %.2f (%.2f) m, %.2f (%.2f) m/s, "
      "%.2f (%.2f) rad/s\n",
      what.c_str(), run.force, control.force, run.torque, control.torque, run.change, run.rise, control.rise,
      run.way, control.way, run.speed, control.speed, run.spin, control.spin);
  EXPECT_LT(run.force, kFactor * control.force) << what;
  EXPECT_LT(run.torque, kFactor * control.torque + 1.0) << what;
  EXPECT_LT(run.change, 20.0) << what;
  // A hold that was taken anew is off by as much as the hand was from the beam: as far as the hands go.
  EXPECT_LT(run.rise, kFactor * control.rise + kSwing) << what;
  EXPECT_LT(run.way, kFactor * control.way + kSwing) << what;
  EXPECT_LT(run.speed, kFactor * control.speed + 0.2) << what;
  EXPECT_LT(run.spin, kFactor * (control.spin + kRampTurn)) << what;
}

struct StalledHands {
  std::size_t people;
  bool feels;  // else a script's: it is told what the world put on it
};

class Stalls : public ::testing::TestWithParam<StalledHands> {
 protected:
  static Worst of(double seconds, const std::function<void(Carrying&, double)>& disturb) {
    Carrying world(GetParam().people, GetParam().feels);
    return world.run(seconds, disturb);
  }
  Worst control_ = of(5.0, [](Carrying&, double) {});
};

TEST_P(Stalls, AProcessThatStandsStillThrowsNothing) {
  std::mt19937 random(11);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  for (int trial = 0; trial < 6; ++trial) {
    struct Pulse {
      double begin, length;
      std::size_t who;
    };
    std::vector<Pulse> pulses;
    for (int i = 0; i < 3; ++i)
      pulses.push_back({between(0.8, 3.5), between(0.05, 0.5), random() % (GetParam().people + 1)});
    const Worst worst = of(5.0, [&](Carrying& run, double t) {
      for (Pulse& pulse : pulses) {
        if (pulse.length <= 0.0 || t < pulse.begin) continue;
        if (pulse.who == 0)
          run.host_stopped_until = t + pulse.length;
        else
          run.stop(pulse.who - 1, t + pulse.length);
        pulse.length = 0.0;
      }
    });
    expect_within(worst, control_, "stopped, trial " + std::to_string(trial));
  }
}

TEST_P(Stalls, APartnerWhoFallsSilentThrowsNothing) {
  if (GetParam().people < 2) return;
  // Whoever is left has all of the weight in the end: the control lets go gently for good.
  const Worst alone = of(5.0, [](Carrying& run, double t) {
    if (t > 1.2 && t < 1.2005) run.let_go(1);
  });
  const Worst worst = of(5.0, [](Carrying& run, double t) {
    if (t > 1.2 && t < 1.2005) run.stop(1, 3.2);
  });
  expect_within(worst, alone, "silent for 2 s");
}

TEST_P(Stalls, SpringsThatAreChangedWhileStrainedThrowNothing) {
  // A soft grip leaves the weight to the other, and sags.
  const Worst soft = of(5.0, [](Carrying& run, double t) {
    if (t > 1.0 && t < 1.0005) {
      ASSERT_TRUE(run.host().world.set_grip_stiffness(0, 0.05));
    }
  });
  for (const double every : {0.06, 0.25, 0.7}) {
    double next = 1.0;
    bool stiff = false;
    const Worst worst = of(5.0, [&](Carrying& run, double t) {
      if (t < next || t > 4.0) return;
      next += every;
      stiff = !stiff;
      ASSERT_TRUE(run.host().world.set_grip_stiffness(0, stiff ? 4.0 : 0.05));
    });
    expect_within(worst, soft, "stiff and soft each " + std::to_string(every) + " s");
  }
}

INSTANTIATE_TEST_SUITE_P(StalledHands, Stalls,
                         ::testing::Values(StalledHands{1, false}, StalledHands{1, true},
                                           StalledHands{2, false}, StalledHands{2, true}));

}  // namespace
}  // namespace slosh
