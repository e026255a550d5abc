// Who lifts before their force has begun, far away: a hand acts on the world from when its person feels it.
#include "distant_people.h"

namespace slosh {
namespace {

using test::kShare;
using test::NotedOperator;

constexpr double kLift = 0.03;          // m
constexpr double kLifted = 0.3;         // s, in which the hand is lifted, from the start on
constexpr double kGripSpring = 2000.0;  // N/m, as held_beam() has it

class FeltHands : public test::DistantPeople {
 protected:
  FeltHands() {
    way = [](std::size_t, const Pose& start) { return PoseTrack({}, start); };
  }
  double felt(std::size_t i) const { return glm::length(people[i]->device->last.force); }
  /// Both people hold on and the first one lifts.
  void lift_for(double seconds) {
    for (int left = static_cast<int>(seconds / 0.001 + 0.5); left > 0; --left) {
      const double share = std::min(0.001 * ++lifted_for_ / kLifted, 1.0);
      people[0]->device->nudge = kLift * share * share * (3.0 - 2.0 * share);
      run(0.001);
    }
  }
  /// What the first person finds when their force begins.
  struct Beginning {
    double after = 0.0;  // s
    double risen = 0.0;  // m, the grip, at most until then
    double held = 0.0;   // J in the springs at the hands beyond what the weight alone has them hold, likewise
    double most = 0.0;   // N, in the 0.2 s that follow
  };
  Beginning begin_to_feel(double round_trip, double jitter, double loss) {
    people.clear();
    clock = to_nanoseconds(1000.0);
    random.seed(7);
    lifted_for_ = 0;
    begin(round_trip, jitter, loss, Coupling::kReplica);
    const std::vector<GripState>& grips = host->now.grips;
    const double start = grips[0].pose.position.y;
    Beginning found;
    while (felt(0) == 0.0 && found.after < 5.0) {
      lift_for(0.001);
      found.after += 0.001;
      found.risen = std::max(found.risen, grips[0].pose.position.y - start);
      double held = 0.0;
      for (const GripState& grip : grips)
        held += 0.5 * (glm::dot(grip.on_hand.force, grip.on_hand.force) - kShare * kShare) / kGripSpring;
      found.held = std::max(found.held, held);
    }
    for (int i = 0; i < 200; ++i) {
      lift_for(0.001);
      found.most = std::max(found.most, felt(0));
    }
    std::printf(
        "%3.0f ms, %2.0f %% lost: felt after %.2f s; until then the grip %.1f mm up, %.1f mJ held; then %.1f "
        "N\n",
        1e3 * round_trip, 1e2 * loss, found.after, 1e3 * found.risen, 1e3 * found.held, found.most);
    return found;
  }

 private:
  int lifted_for_ = 0;  // ms
};

TEST_F(FeltHands, MoveNothingBefore) {
  for (const double round_trip : {0.2, 0.3, 0.5}) {
    for (const bool bad : {false, true}) {
      const Beginning found = begin_to_feel(round_trip, bad ? 0.04 : 0.0, bad ? 0.2 : 0.0);
      EXPECT_LT(found.after, 4.0);
      EXPECT_LT(found.risen, 1e-3) << "the stand holds it";
      EXPECT_LT(found.held, 1e-3);
      EXPECT_LT(found.most, kShare + 2.0) << "no more than the stand had";
      const double start = host->now.grips[0].pose.position.y;
      lift_for(8.0);
      EXPECT_LE(step(), 1.001e-3 * NotedOperator::kForceRate);
      EXPECT_LT(peak(), 2.5 * kShare);
      forget();
      lift_for(2.0);
      if (bad) continue;  // there a passivity controller cuts now and then, whenever somebody lifted
      // Their holds lifted it, and that is no energy which they would have to give back: no controller cuts
      // off the force.
      EXPECT_GT(host->now.grips[0].pose.position.y, start + 0.7 * kLift);
      EXPECT_NEAR(felt(0) + felt(1), 2.0 * kShare, 0.5) << "all of it is carried,";
      EXPECT_LT(step(), 0.05) << "and held";
    }
  }
}

/// One is near and holds the beam, the other far away and not heard for 1.5 s, while both tilt it by 0.2 rad:
/// 27 N at once where the host took the far hand with its first pose.
TEST_F(FeltHands, AreNotStruckByWhatAnotherDidMeanwhile) {
  way = [](std::size_t person, const Pose& start) {
    std::vector<PoseKey> keys;
    for (const auto& [time, share] : {std::pair{1.0, 0.0}, {2.0, 1.0}}) {
      const double turn = 0.2 * share;
      const glm::dvec3 arm(person == 0 ? -0.15 : 0.15, 0.0, 0.0);
      PoseKey& key = keys.emplace_back();
      key.time = time;
      key.pose.orientation = rotate_by(start.orientation, {0.0, 0.0, turn});
      key.pose.position = start.position + glm::angleAxis(turn, glm::dvec3(0.0, 0.0, 1.0)) * arm - arm;
    }
    return PoseTrack(keys, start);
  };
  begin(0.5, 0.04, 0.2, Coupling::kReplica);
  people[1]->up.delay = people[1]->down.delay = 0.01;
  people[0]->up.dark = true;
  run(1.5);
  people[0]->up.dark = false;
  double begins = 0.0;
  for (int left = 2000; left > 0 && felt(0) == 0.0; --left) run(0.001);
  for (int left = 100; left > 0; --left) {
    run(0.001);
    begins = std::max(begins, felt(0));
  }
  std::printf("it begins with %.1f N at most\n", begins);
  EXPECT_GT(begins, 0.0);
  EXPECT_LT(begins, 6.0) << "over half a second, as for any hand that takes over a weight";
  run(4.0);
  EXPECT_LT(peak(), 2.0 * kShare);
}

/// A host that does not know of it is met as before: both ends take hold with the first pose.
TEST_F(FeltHands, AnOlderHostTakesThemAtOnce) {
  agreed &= ~wire::kFeltHands;
  const Beginning found = begin_to_feel(0.5, 0.0, 0.0);
  EXPECT_GT(found.risen, 0.3 * kLift);
  EXPECT_LT(found.after, 4.0);
}

}  // namespace
}  // namespace slosh
