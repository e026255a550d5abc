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

/// The run up to a time, with these hands alone.
ScriptedRun part_of(const ScriptedRun& run, double until, const std::vector<std::size_t>& hands) {
  ScriptedRun part;
  const std::vector<double>& time = run.hands.front().time;
  const auto rows = std::ranges::upper_bound(time, until) - time.begin();
  for (const std::size_t hand : hands) {
    const WrenchSeries& all = run.hands[hand];
    part.hands.push_back(
        {{all.time.begin(), all.time.begin() + rows}, {all.on_hand.begin(), all.on_hand.begin() + rows}});
    part.poses.emplace_back(run.poses[hand].begin(), run.poses[hand].begin() + rows);
    part.centers.emplace_back(run.centers[hand].begin(), run.centers[hand].begin() + rows);
  }
  return part;
}

}  // namespace

FigureParts judge_crepe_pour(const ScriptedRun& run) {
  // Up to when the bowl is upright again; later the pan is tilted, and the bowl taken away.
  const WrenchSeries& bowl = run.hands[kBowlHand];
  const std::vector<Phase> turns = strokes(bowl.time, turning(run, kBowlHand));
  double upright = bowl.time.back();
  for (std::size_t i = 1; i < turns.size(); ++i)
    if (turns[i - 1].name != turns[i].name) {
      upright = turns[i].to;
      break;
    }
  FigureParts parts = judge_pour(part_of(run, upright, {kBowlHand, kPanHand}));
  parts.claims[0].paper =
      "he feels the weight shifting between his hands as the batter goes from the bowl to the pan";
  parts.claims[1].paper = "he feels the forces and torques from the pouring movement (torque peak)";
  parts.claims[2].paper = "the same (torque decrease once it has run out)";
  return parts;
}

FigureParts judge_crepe_tools(const ScriptedRun& run) {
  const WrenchSeries& whisk = run.hands[kWhiskHand];
  const WrenchSeries& ladle = run.hands[kLadleHand];
  // While the whisk goes round in the batter its way across is all that it moves.
  const std::vector<glm::dvec3> velocity = velocities(run, kWhiskHand);
  std::vector<double> across, against;
  double fastest = 0.0;
  for (const glm::dvec3& v : velocity) fastest = std::max(fastest, std::hypot(v.x, v.z));
  double begin = whisk.time.back(), end = 0.0, opposed = 0.0, all = 0.0;
  WrenchSeries resisting;
  for (std::size_t i = 0; i < whisk.time.size(); ++i) {
    const double speed = std::hypot(velocity[i].x, velocity[i].z);
    const double along = whisk.on_hand[i].force.x * velocity[i].x + whisk.on_hand[i].force.z * velocity[i].z;
    resisting.time.push_back(whisk.time[i]);
    resisting.on_hand.push_back({{speed > 1e-6 ? -along / speed : 0.0, 0.0, 0.0}, {}});
    const bool stirs = whisk.time[i] < 8.0 && speed > 0.3 * fastest && std::abs(velocity[i].y) < 0.3 * speed;
    if (!stirs) continue;
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
