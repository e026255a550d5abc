// The paper's Figures 12 and 13: its crêpe, told in pictures there, in forces here.
#include <algorithm>
#include <cmath>

#include "sim/math/format.h"
#include "tests/lab/verbs/figure_kit.h"

namespace slosh {
namespace {

using namespace figure;

// The grips of the shipped scene, in its order.
constexpr std::size_t kBowlHand = 0, kWhiskHand = 1, kPanHand = 2, kLadleHand = 4;

double down(const Wrench& w) {
  return -w.force.y;
}

/// Stretches in which a hand is more than `high` m over where it began, from when it has been there for a
/// second.
std::vector<Phase> lifted(const ScriptedRun& run, std::size_t hand, double high) {
  std::vector<Phase> found;
  bool up = false;
  for (std::size_t i = 0; i < run.poses[hand].size(); ++i) {
    const double time = run.hands[hand].time[i];
    const bool now = run.poses[hand][i].position.y - run.poses[hand].front().position.y > high;
    if (now && !up) found.push_back({"lifted", time + 1.0, time + 1.0});
    if (now) found.back().to = std::max(found.back().from, time);
    up = now;
  }
  return found;
}

}  // namespace

FigureParts judge_crepe_pour(const ScriptedRun& run) {
  const WrenchSeries& bowl = run.hands[kBowlHand];
  const WrenchSeries& pan = run.hands[kPanHand];
  const std::vector<Phase> turns = strokes(bowl.time, turning(run, kBowlHand));
  const double end = bowl.time.back();
  const double tilt = turns.empty() ? end : turns.front().from;
  const double back = turns.size() > 1 ? turns.back().from : end;
  const Phase rest{"", std::max(tilt - 1.0, 0.0), tilt}, poured{"", back - 0.3, back};
  // The pan stands on the hob while it is poured into; its hand feels what it holds once it is lifted. Empty
  // it is lifted last.
  const std::vector<Phase> lifts = lifted(run, kPanHand, 0.025);
  const double full = lifts.empty() ? 0.0 : mean(pan, lifts.front(), down);
  const Phase last{"", end - 1.0, end};
  const double empty = mean(pan, last, down);
  const double lost = mean(bowl, rest, down) - mean(bowl, poured, down), gained = full - empty;
  const WrenchSeries inside = about_centers(run, kBowlHand);
  const double at_rest = mean(inside, rest, torque_size);
  const figure::Peak top = peak(inside, {"", tilt, back}, torque_size);
  const double emptied = mean(inside, poured, torque_size);

  FigureParts parts;
  parts.panels = {panel_of("", "weight in the hand, N"),
                  panel_of("", "torque about the middle of the bowl, N\xC2\xB7m")};
  parts.panels[0].series = {curve("bowl", bowl, down, 1), curve("pan", pan, down, 0)};
  parts.panels[1].series = {curve("bowl", inside, torque_size, 1)};
  for (ChartPanel& panel : parts.panels)
    mark_phases(panel, {{"stir", 0.0, tilt}, {"pour", tilt, back}, {"bake, serve", back, end}});
  parts.claims = {
      {"the user feels the forces and torques from the pouring movement",
       format("about the bowl's middle %.4f N\xC2\xB7m at rest, %.4f N\xC2\xB7m at the peak, %.4f "
              "N\xC2\xB7m once it is empty",
              at_rest, top.value, emptied),
       top.value > 2.0 * at_rest && emptied < 0.5 * top.value},
      {"as well as the weight shifting between his hands as the batter goes from the bowl to the pan",
       format("the bowl's hand loses %.3f N, the pan's, lifted off its hob, holds %.3f N more than with "
              "nothing in it (%.0f %%)",
              lost, gained, lost > 0.0 ? 100.0 * gained / lost : 0.0),
       lost > 0.5 && gained > 0.9 * lost && gained < 1.02 * lost}};
  return parts;
}

FigureParts judge_crepe_tools(const ScriptedRun& run) {
  const WrenchSeries& whisk = run.hands[kWhiskHand];
  const WrenchSeries& ladle = run.hands[kLadleHand];
  // While the whisk goes round in the batter its way across is all that it moves.
  const std::vector<glm::dvec3> velocity = velocities(run, kWhiskHand);
  double low = run.poses[kWhiskHand].front().position.y, fastest = 0.0;
  for (const Pose& pose : run.poses[kWhiskHand]) low = std::min(low, pose.position.y);
  const auto is_low = [&](std::size_t i) { return run.poses[kWhiskHand][i].position.y < low + 0.02; };
  for (std::size_t i = 0; i < velocity.size(); ++i)
    if (is_low(i)) fastest = std::max(fastest, std::hypot(velocity[i].x, velocity[i].z));
  double begin = whisk.time.back(), end = 0.0, opposed = 0.0, all = 0.0;
  WrenchSeries resisting;
  for (std::size_t i = 0; i < whisk.time.size(); ++i) {
    const double speed = std::hypot(velocity[i].x, velocity[i].z);
    const double along = whisk.on_hand[i].force.x * velocity[i].x + whisk.on_hand[i].force.z * velocity[i].z;
    resisting.time.push_back(whisk.time[i]);
    resisting.on_hand.push_back({{speed > 1e-6 ? -along / speed : 0.0, 0.0, 0.0}, {}});
    if (!is_low(i) || speed < 0.5 * fastest) continue;
    begin = std::min(begin, whisk.time[i]);
    end = std::max(end, whisk.time[i]);
    all += 1.0;
    opposed += along < 0.0 ? 1.0 : 0.0;
  }
  const Reading resists = [](const Wrench& w) { return w.force.x; };
  const Phase stirring{"stirring", begin, end};
  const double share = all > 0.0 ? opposed / all : 0.0;
  // The ladle comes with its syrup in it; what it is lighter by at the end was poured.
  double came = ladle.time.back();
  for (std::size_t i = 0; i < ladle.time.size(); ++i)
    if (down(ladle.on_hand[i]) > 0.5) {
      came = ladle.time[i];
      break;
    }
  const std::vector<Phase> turns = strokes(ladle.time, turning(run, kLadleHand));
  const double tilt = turns.empty() ? ladle.time.back() : turns.front().from;
  const double back = turns.empty() ? ladle.time.back() : turns.back().to;
  const Phase full{"full", std::max(came, tilt - 0.6), tilt - 0.1}, pouring{"pouring", tilt, back},
      after{"after", back + 0.2, ladle.time.back()};
  const double before = mean(ladle, full, down), left = mean(ladle, after, down);

  FigureParts parts;
  parts.panels = {panel_of("", "resistance to the whisk along its way, N"),
                  panel_of("", "weight in the ladle's hand, N")};
  parts.panels[0].series = {curve("whisk", resisting, resists, 1)};
  parts.panels[1].series = {curve("ladle", ladle, down, 0)};
  mark_phases(parts.panels[0], {{"", 0.0, begin}, stirring, {"", end, whisk.time.back()}});
  mark_phases(parts.panels[1], {{"", 0.0, full.from}, full, pouring, after});
  parts.claims = {
      {"a bowl coupled to the 6DoF haptic device is used to stir the batter (here a whisk)",
       format("while it goes round the batter resists for %.0f %% of the time, %.3f N in the mean, %.2f N at "
              "most",
              100.0 * share, mean(resisting, stirring, resists), peak(resisting, stirring, resists).value),
       share > 0.8},
      {"and the same bowl pours maple syrup on the crepe (here a ladle)",
       format("the ladle weighs %.3f N full and %.3f N afterwards: %.0f g were poured", before, left,
              1e3 * (before - left) / 9.81),
       before - left > 0.1}};
  return parts;
}

}  // namespace slosh
