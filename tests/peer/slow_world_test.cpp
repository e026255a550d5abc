// Hands in a world that is slower than real time, or stops and starts: the force is that of a world that
// keeps up. Deterministic: a clock that the test moves (hand_rig.h).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "hand_rig.h"
#include "tests/physics/fluid_wrench_kit.h"

namespace slosh {
namespace {

using test::FeltTick;
using test::HandRig;
using test::RigOptions;

constexpr double kSeconds = 3.0;

/// To and fro by 30 mm, from rest to rest within 2 s.
std::vector<PoseKey> stirring(const Pose& start) {
  std::vector<PoseKey> keys;
  for (double t = 0.0; t <= 2.0; t += 0.01) {
    PoseKey& key = keys.emplace_back();
    key.time = t;
    key.pose = start;
    const double swell = 0.5 * (1.0 - std::cos(lab::kPi * t));
    key.pose.position.x += 0.03 * swell * std::sin(2.0 * lab::kPi * t);
  }
  return keys;
}

struct Stirred {
  std::vector<FeltTick> ticks;
  double rate = 1.0;   // said by the host at the end
  double peak = 0.0;   // N
  double swing = 0.0;  // m/s, the fastest that the hand still is in the last half second
};

/// An operator stirs; `takes(t)`: steps' time in units of their own length.
Stirred stir(double viscosity, const char* grip, RigOptions options,
             const std::function<double(double)>& takes) {
  const Scene scene = lab::spoon_in(viscosity);
  const Pose start = grip_start(scene, 0);
  auto person =
      std::make_unique<OperatorDevice>(PoseTrack(stirring(start), start), parse_operator(grip).value());
  options.sub_steps = 2;
  options.step_takes = [takes](double t) { return 0.002 * takes(t); };
  HandRig rig(scene, std::move(person), options);
  rig.run(kSeconds);
  Stirred s{rig.ticks(), rig.rate(), 0.0, 0.0};
  s.peak = peak_force(s.ticks);
  for (const FeltTick& tick : s.ticks)
    if (tick.time > kSeconds - 0.5) s.swing = std::max(s.swing, glm::length(tick.twist.linear));
  return s;
}

class SlowWorld : public ::testing::TestWithParam<const char*> {};

TEST_P(SlowWorld, ASimulatedPersonFeelsWhatTheyFeelInOneThatKeepsUp) {
  const Stirred reference = stir(2.0, GetParam(), {}, [](double) { return 0.5; });
  for (const double slower : {1.05, 2.2}) {
    const Stirred slow = stir(2.0, GetParam(), {}, [slower](double) { return slower; });
    const double off = force_off(slow.ticks, reference.ticks, 0.5, kSeconds);
    std::printf(
        "%s, %.2f times slower: peak %.2f N for %.2f, force off by %.1f %%, swing %.4f m/s, pace %.3f\n",
        GetParam(), slower, slow.peak, reference.peak, 1e2 * off, slow.swing, slow.rate);
    EXPECT_LE(slow.peak, 1.05 * reference.peak) << slower;
    EXPECT_LE(off, 0.06) << slower;
    EXPECT_NEAR(slow.rate, 1.0 / slower, 0.05 / slower) << "what the host says";
  }
}

TEST_P(SlowWorld, StepsOfAllLengthsAndStopsDoNotSwing) {
  const Stirred reference = stir(2.0, GetParam(), {}, [](double) { return 0.5; });
  // Twice as slow, each third step four times the others; and a world that hangs for 0.3 s every second.
  int step = 0;
  const Stirred uneven = stir(2.0, GetParam(), {}, [&step](double) { return ++step % 3 == 0 ? 4.0 : 1.0; });
  const Stirred stops = stir(2.0, GetParam(), {}, [](double t) {
    const double since = std::fmod(t, 1.0);
    return since > 0.498 && since < 0.5 ? 150.0 : 0.5;
  });
  for (const Stirred* s : {&uneven, &stops}) {
    std::printf("%s, %s: peak %.2f N for %.2f, swing %.4f m/s\n", GetParam(),
                s == &uneven ? "uneven" : "stops", s->peak, reference.peak, s->swing);
    EXPECT_LE(s->peak, 1.05 * reference.peak);
    // A world that hangs holds nothing up meanwhile.
    EXPECT_LE(s->swing, reference.swing + (s == &stops ? 0.006 : 0.001));
  }
}

/// By the wall the spoon's weight and syrup are what they are to somebody who moves so much faster; the hand
/// is not driven.
TEST_P(SlowWorld, WhoGoesByTheWallIsNotDriven) {
  RigOptions wall;
  wall.on_the_wall = true;
  for (const double slower : {0.5, 1.2}) {
    const Stirred slow = stir(2.0, GetParam(), wall, [slower](double) { return slower; });
    std::printf("%s by the wall, %.2f times slower: peak %.2f N, swing %.4f m/s\n", GetParam(), slower,
                slow.peak, slow.swing);
    EXPECT_LE(slow.swing, 0.002) << slower;
    EXPECT_LE(slow.peak, 60.0) << slower;
  }
}

INSTANTIATE_TEST_SUITE_P(Grips, SlowWorld, ::testing::Values("tight"));

}  // namespace
}  // namespace slosh
