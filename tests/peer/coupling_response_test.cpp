// What a hand is rendered: its impedance against the commanded one, and what the host's rate leaves in its
// force.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

#include "tests/lab/coupling/response.h"

namespace slosh::coupling {
namespace {

constexpr double kTaken = 10.0;  // s: a period of the slowest tone

Case toned(int hands, double round_trip) {
  Case c;
  c.hands = hands;
  c.tones = transparency_tones();
  c.seconds = 5.0 + kTaken;
  c.round_trip = round_trip;
  return c;
}

std::vector<Impedance> rendered(const Case& c, Scheme scheme) {
  return impedance(run(c, scheme), c.hands, c.tones, kTaken);
}

/// At no delay: the body's mass where the coupling follows, the coupling's spring and damper where the body
/// does not. Between them the body also turns, as its grips are beside its centre.
TEST(Transparency, AtNoDelayItIsTheMassAndThenTheCoupling) {
  const Case c = toned(1, 0.0);
  int looked = 0;
  for (const Impedance& z : rendered(c, Scheme::kZeroDelay)) {
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi * z.frequency);
    if (z.frequency > 0.55 && z.frequency < 20.0) continue;
    const std::complex<double> wanted = z.frequency < 1.0 ? 2.5 * s : 1000.0 / s + 30.0;
    EXPECT_NEAR(z.size, std::abs(wanted), 0.15 * std::abs(wanted)) << z.frequency;
    EXPECT_NEAR(z.phase, std::arg(wanted), 0.35) << z.frequency;
    looked += 1;
  }
  EXPECT_EQ(looked, 6);
}

/// The distance is not felt where the own hand alone moves the body, and far less than by a spring else.
TEST(Transparency, TheReplicaRendersWhatIsCommanded) {
  for (const int hands : {1, 2}) {
    const std::vector<Impedance> commanded = rendered(toned(hands, 0.0), Scheme::kZeroDelay);
    for (const double round_trip : {0.05, 0.2}) {
      const double ours = farthest_off(rendered(toned(hands, round_trip), Scheme::kReplica), commanded);
      const double spring = farthest_off(rendered(toned(hands, round_trip), Scheme::kPeerSpring), commanded);
      std::printf("%d hands, %.0f ms: impedance off by %.0f %% at most, by a spring %.0f %%\n", hands,
                  1e3 * round_trip, 1e2 * ours, 1e2 * spring);
      if (hands == 1) {
        EXPECT_LE(ours, 0.10);
      }
      EXPECT_LT(ours, spring);
    }
  }
}

/// A spoon's syrup at a host of 100 Hz, against one of 1 kHz beside the hand.
TEST(Spectrum, TheModelTakesTheHostsRateOutOfTheForce) {
  Case c;
  c.hands = 1;
  c.body_mass = 1.0;
  c.round_trip = 0.0;
  c.grip = "tight,tremor=0.0005";
  c.seconds = 5.0;
  c.load = Load::kSyrup;
  const Outcome reference = run(c, Scheme::kZeroDelay);
  c.host_rate = 100.0;
  const Outcome told = run(c, Scheme::kReplica);
  const Outcome held = run(c, Scheme::kHostForce);
  const auto tone = [](const Outcome& o) { return tone_at(force_spectrum(o, 1, 0.5, 4.5), 100.0); };
  std::printf("host at 100 Hz: off by %.1f %%, tone %.2f %%; its force held: %.1f %%, %.2f %%\n",
              1e2 * force_error(told, reference), 1e2 * tone(told), 1e2 * force_error(held, reference),
              1e2 * tone(held));
  EXPECT_LE(force_error(told, reference), 0.10);
  EXPECT_LE(tone(told), 0.01);
  EXPECT_GT(force_error(held, reference), 2.0 * force_error(told, reference));
}

TEST(Spectrum, AToneIsFoundWhereItIs) {
  Outcome made;
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.001 * i;
    Wrench w;
    w.force.x =
        2.0 * std::sin(2.0 * std::numbers::pi * 3.0 * t) + 0.1 * std::sin(2.0 * std::numbers::pi * 100.0 * t);
    made.felt.push_back(w);
  }
  const std::vector<Line> lines = force_spectrum(made, 1, 0.0, 4.0);
  EXPECT_NEAR(tone_at(lines, 100.0), 0.05, 0.002);
  EXPECT_LT(tone_at(lines, 200.0), 1e-3);
}

}  // namespace
}  // namespace slosh::coupling
