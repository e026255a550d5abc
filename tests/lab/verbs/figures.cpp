#include "tests/lab/verbs/figures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/math/format.h"
#include "tests/lab/verbs/figure_kit.h"

namespace slosh {
namespace {

using namespace figure;
constexpr std::array kAxes{"x", "y", "z"};
constexpr double kSame = 1.1;     // curves that are less apart than this ratio are drawn on each other
constexpr double kRise = 1.02;    // less than this ratio is noise
constexpr double kVisible = 0.1;  // of the largest: less is flat in a plot

}  // namespace

const char* scene_of_figure(int number) {
  switch (number) {
    case 8:
      return "spoon";
    case 9:
      return "pour";
    case 10:
      return "spin";
    case 11:
      return "bucket";
    case 12:
    case 13:
      return "crepe";
    default:
      return nullptr;
  }
}

FigureParts judge_spoon(const ScriptedRun& run, bool tare) {
  const WrenchSeries& hand = run.hands[0];
  const std::vector<glm::dvec3> velocity = velocities(run, 0);
  const int axis = static_cast<int>(liveliest(velocity));
  std::vector<double> speed;
  double fastest = 0.0;
  for (const glm::dvec3& v : velocity) {
    speed.push_back(v[axis]);
    fastest = std::max(fastest, std::abs(v[axis]));
  }
  const std::vector<Phase> moves = strokes(hand.time, speed);
  const Phase rest{"rest", 0.0, moves.empty() ? hand.time.back() : moves.front().from};
  Wrench still;
  for (int i = 0; i < 3; ++i) {
    still.force[i] = mean(hand, rest, [i](const Wrench& w) { return w.force[i]; });
    still.torque[i] = mean(hand, rest, [i](const Wrench& w) { return w.torque[i]; });
  }
  std::vector<glm::dvec3> torques;
  double against = 0.0, all = 0.0, along2 = 0.0, total2 = 0.0;
  for (std::size_t i = 0; i < hand.time.size(); ++i) {
    const glm::dvec3 torque = hand.on_hand[i].torque - still.torque;
    torques.push_back(torque);
    if (std::abs(speed[i]) < 0.2 * fastest) continue;
    all += 1.0;
    against += (hand.on_hand[i].force[axis] - still.force[axis]) * speed[i] < 0.0 ? 1.0 : 0.0;
    along2 += torque[axis] * torque[axis];
    total2 += glm::dot(torque, torque);
  }
  const int about = static_cast<int>(liveliest(torques));
  const double share = all > 0.0 ? against / all : 0.0;
  const double along = total2 > 0.0 ? std::sqrt(along2 / total2) : 1.0;
  const Reading force = [=](const Wrench& w) { return w.force[axis] - (tare ? still.force[axis] : 0.0); };
  const Reading torque = [=](const Wrench& w) {
    return w.torque[about] - (tare ? still.torque[about] : 0.0);
  };
  const double rest_force = glm::length(still.force);
  const std::string tared = tare ? ", less its rest" : "";

  FigureParts parts;
  std::vector<Phase> phases{rest};
  phases.insert(phases.end(), moves.begin(), moves.end());
  phases.push_back({"rest", phases.back().to, hand.time.back()});
  parts.panels = {
      panel_of("", format("force along %s%s, N", kAxes[static_cast<std::size_t>(axis)], tared.c_str())),
      panel_of("", format("torque about %s%s, N\xC2\xB7m", kAxes[static_cast<std::size_t>(about)],
                          tared.c_str()))};
  parts.panels[0].series.push_back(curve("spoon", hand, force, 0));
  parts.panels[1].series.push_back(curve("spoon", hand, torque, 0));
  for (ChartPanel& panel : parts.panels) mark_phases(panel, phases);
  const Phase moving{"", rest.to, hand.time.back()};
  const auto forward =
      std::count_if(moves.begin(), moves.end(), [](const Phase& move) { return move.name == "forward"; });
  const auto backward = static_cast<std::ptrdiff_t>(moves.size()) - forward;
  parts.claims = {
      {"the force goes opposite to the back-to-front movement of the spoon",
       format("along %s, where the spoon moves, the force opposes the motion for %.0f %% of the time; its "
              "peak is %.3f N, "
              "and the hand carries %.2f N at rest",
              kAxes[static_cast<std::size_t>(axis)], 100.0 * share,
              peak(hand, moving, [=](const Wrench& w) { return w.force[axis] - still.force[axis]; }).value,
              rest_force),
       share > 0.8},
      {"the torque is generated through a rotation around an axis orthogonal to the linear movement",
       format(
           "the torque varies most about %s; the part along the movement is %.0f %% of it (rms); peak %.4f "
           "N\xC2\xB7m",
           kAxes[static_cast<std::size_t>(about)], 100.0 * along,
           peak(hand, moving, [=](const Wrench& w) { return w.torque[about] - still.torque[about]; }).value),
       about != axis && along < 0.3},
      {"3 forward and backward movements", format("%td forward, %td backward", forward, backward),
       forward >= 3 && backward >= 3}};
  return parts;
}

FigureParts judge_pour(const ScriptedRun& run) {
  const WrenchSeries& bowl = run.hands[0];
  const WrenchSeries& pan = run.hands[1];
  const std::vector<Phase> turns = strokes(bowl.time, turning(run, 0));
  const double end = bowl.time.back();
  const double tilt = turns.empty() ? end : turns.front().from;
  const double tilted = turns.empty() ? end : turns.front().to;
  const double back = turns.size() > 1 ? turns[1].from : end;
  const std::vector<Phase> phases{
      {"rest", 0.0, tilt}, {"tilt", tilt, tilted}, {"held", tilted, back}, {"back", back, end}};
  const Reading weight = [](const Wrench& w) { return -w.force.y; };
  const Phase last{"", std::max(back - 0.5, 0.0), back};
  const double lost = mean(bowl, phases[0], weight) - mean(bowl, last, weight);
  const double gained = mean(pan, last, weight) - mean(pan, phases[0], weight);
  // The paper does not say where its bowl is held. About the bowl's own middle, its weight has no torque
  // wherever that is, and what is left is the fluid's.
  const WrenchSeries inside = about_centers(run, 0);
  const WrenchSeries pan_inside = about_centers(run, 1);
  const double at_rest = mean(inside, phases[0], torque_size);
  const figure::Peak top = peak(inside, {"", tilt, back}, torque_size);
  const double emptied = mean(inside, last, torque_size);

  FigureParts parts;
  parts.panels = {panel_of("", "weight in the hand, N"),
                  panel_of("", "torque about the middle of the vessel, N\xC2\xB7m"),
                  panel_of("", "torque about the handle, N\xC2\xB7m")};
  // As in the paper: the bowl blue, the pan red.
  parts.panels[0].series = {curve("bowl", bowl, weight, 1), curve("pan", pan, weight, 0)};
  parts.panels[1].series = {curve("bowl", inside, torque_size, 1), curve("pan", pan_inside, torque_size, 0)};
  parts.panels[2].series = {curve("bowl", bowl, torque_size, 1), curve("pan", pan, torque_size, 0)};
  for (ChartPanel& panel : parts.panels) mark_phases(panel, phases);
  parts.claims = {
      {"weight shifts from the bowl to the pan",
       format("the bowl's hand loses %.3f N, the pan's gains %.3f N (%.0f %%)", lost, gained,
              lost > 0.0 ? 100.0 * gained / lost : 0.0),
       lost > 0.5 && gained > 0.9 * lost && gained < 1.02 * lost},
      {"the bowl is first tilted (torque peak)",
       format("about the bowl's middle %.4f N\xC2\xB7m at rest, %.4f N\xC2\xB7m at the peak, %.2f s into the "
              "tilt of %.2f s; about "
              "the handle %.3f and %.3f N\xC2\xB7m",
              at_rest, top.value, top.time - tilt, tilted - tilt, mean(bowl, phases[0], torque_size),
              peak(bowl, {"", tilt, back}, torque_size).value),
       top.value > 2.0 * at_rest && top.time > tilt && top.time < tilted},
      {"and then emptied (torque decrease)",
       format("%.4f N\xC2\xB7m once it is empty, still tilted: %.0f %% of the peak", emptied,
              top.value > 0.0 ? 100.0 * emptied / top.value : 0.0),
       emptied < 0.5 * top.value}};
  return parts;
}

FigureParts judge_spin(const ScriptedRun& run, const std::string& model) {
  constexpr std::array<std::size_t, 4> kColors{1, 0, 2, 3};  // the paper's: blue, red, yellow, green
  constexpr std::array<const char*, 4> kNames{"2 Pa\xC2\xB7s", "10 Pa\xC2\xB7s", "20 Pa\xC2\xB7s",
                                              "40 Pa\xC2\xB7s"};
  const std::vector<double>& time = run.hands[0].time;
  const std::vector<double> rate = turning(run, 0);
  const double full = *std::max_element(rate.begin(), rate.end());
  // Rest until it turns; start until it turns at its full rate; spin until it slows; stop.
  std::array<double, 3> begins{time.back(), time.back(), time.back()};
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (begins[0] == time.back() && rate[i] > 1e-4 * full) begins[0] = time[i];
    if (begins[1] == time.back() && rate[i] > 0.99 * full) begins[1] = time[i];
    if (begins[1] < time.back() && begins[2] == time.back() && rate[i] < 0.98 * full) begins[2] = time[i];
  }
  const std::vector<Phase> phases{{"rest", 0.0, begins[0]},
                                  {"start", begins[0], begins[1]},
                                  {"spin", begins[1], begins[2]},
                                  {"stop", begins[2], time.back()}};
  const Reading torque = [](const Wrench& w) { return w.torque.y; };
  FigureParts parts;
  parts.panels = {panel_of(model, "torque about the axis, N\xC2\xB7m")};
  std::string said;
  bool start_apart = true, spin_apart = true, seen = true;
  double start_before = 0.0, spin_before = 0.0;
  const Phase steady{"", 0.5 * (begins[1] + begins[2]), begins[2]};  // what the start threw has gone by then
  for (std::size_t i = 0; i < run.hands.size() && i < kNames.size(); ++i) {
    const WrenchSeries& hand = run.hands[i];
    parts.panels[0].series.push_back(curve(kNames[i], hand, torque, kColors[i]));
    const double rest = peak(hand, phases[0], torque).value;
    const double start = peak(hand, phases[1], torque).value;
    const double spin = std::abs(mean(hand, steady, torque));
    const double stop = peak(hand, phases[3], torque).value;
    said += format("%s%s: rest %.4f, start %.4f, spin %.4f, stop %.4f", i > 0 ? "; " : "", kNames[i], rest,
                   start, spin, stop);
    if (i > 0) {
      start_apart &= start > kSame * start_before;
      spin_apart &= spin > kSame * spin_before && spin > kVisible * start;
    }
    seen &= rest < kVisible * start && spin > kVisible * start && stop > (1.0 + kVisible) * spin;
    start_before = start;
    spin_before = spin;
  }
  mark_phases(parts.panels[0], phases);
  parts.reproduced = start_apart && spin_apart && seen;
  parts.panels[0].title +=
      parts.reproduced ? ": as in the paper, the four are apart" : ": not as in the paper";
  parts.claims = {
      {"the increase in viscosity leads to higher forces, each of the 4 viscosities clearly shown (" + model +
           ")",
       format("N\xC2\xB7m, %s. Peaks at the start %s, plateaus of the spin %s (by a tenth each)",
              said.c_str(), start_apart ? "rise and are apart" : "do not come apart",
              spin_apart ? "rise and are apart" : "do not come apart"),
       start_apart && spin_apart},
      {"each of the 4 phases (rest, start, spin, stop) clearly shown (" + model + ")",
       seen ? "still at rest, a peak, a plateau, a peak for every glass"
            : "not for every glass: a phase is less than a tenth of the start's peak, or rest is more",
       seen}};
  return parts;
}

FigureParts judge_bucket(const ScriptedRun& run) {
  const WrenchSeries& left = run.hands[0];
  const WrenchSeries& right = run.hands[1];
  const std::vector<double>& time = left.time;
  // The paper sums a device's torque at the body's centre of mass (Eq 11, Algorithm 2). About the handle
  // there is only what its spring is turned by, and one rigid bucket turns both springs alike.
  const WrenchSeries left_about = about_centers(run, 0);
  const WrenchSeries right_about = about_centers(run, 1);
  // The tilt about z, rad; positive lowers the left.
  std::vector<double> rate(time.size(), 0.0);
  std::vector<double> angle(time.size(), 0.0);
  for (std::size_t i = 0; i < time.size(); ++i) {
    angle[i] = rotation_between(run.poses[0].front().orientation, run.poses[0][i].orientation).z;
    if (i > 0) rate[i] = (angle[i] - angle[i - 1]) / (time[i] - time[i - 1]);
  }
  // A reading of the lower hand upright before a tilt, its largest while it tilts, and of both at the end.
  struct Shares {
    double upright, top, lower, upper;
    bool rises() const { return top > kRise * upright; }
  };
  struct Tilt {
    double time, angle;
    Shares force, middle, handle;
  };
  std::vector<Tilt> tilts;
  for (const Phase& turn : strokes(time, rate)) {
    const auto end =
        static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), turn.to) - time.begin());
    const std::size_t i = std::min(end, time.size() - 1);
    if (std::abs(angle[i]) < 0.2) continue;  // upright again
    std::size_t upright = i;
    while (upright > 0 && std::abs(angle[upright - 1]) < std::abs(angle[upright])) --upright;
    const Phase before{"", time[upright] - 0.05, time[upright] + 0.05};
    const Phase tilting{"", time[upright], turn.to + 0.1};
    const Phase held{"", turn.to - 0.1, turn.to + 0.1};
    const auto shares = [&](const WrenchSeries& one, const WrenchSeries& other, const Reading& of) {
      const WrenchSeries& low = angle[i] > 0.0 ? one : other;
      const WrenchSeries& high = angle[i] > 0.0 ? other : one;
      return Shares{mean(low, before, of), peak(low, tilting, of).value, mean(low, held, of),
                    mean(high, held, of)};
    };
    tilts.push_back({turn.to, angle[i], shares(left, right, force_size),
                     shares(left_about, right_about, torque_size), shares(left, right, torque_size)});
  }
  FigureParts parts;
  parts.panels = {panel_of("", "force on the hand, N"),
                  panel_of("", "torque about the bucket's middle, N\xC2\xB7m"),
                  panel_of("", "torque about the handle, N\xC2\xB7m")};
  parts.panels[0].series = {curve("left hand", left, force_size, 0),
                            curve("right hand", right, force_size, 1, true)};
  parts.panels[1].series = {curve("left hand", left_about, torque_size, 0),
                            curve("right hand", right_about, torque_size, 1, true)};
  // Curves on each other cannot be told apart: one is drawn, and says so.
  const double left_top = peak(left, {"", 0.0, time.back()}, torque_size).value;
  double apart = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i)
    apart = std::max(apart, std::abs(torque_size(left.on_hand[i]) - torque_size(right.on_hand[i])));
  const bool one_curve = apart <= (kSame - 1.0) * left_top;
  if (one_curve) {
    parts.panels[2].series = {curve("either hand: the same", left, torque_size, 4)};
  } else {
    parts.panels[2].series = {curve("left hand", left, torque_size, 0),
                              curve("right hand", right, torque_size, 1, true)};
  }
  std::vector<Phase> phases;
  std::string said, torques;
  bool force_rises = !tilts.empty(), middle_rises = force_rises, handle_rises = force_rises;
  bool lower_more = force_rises, middle_more = force_rises, handle_more = force_rises;
  for (const Tilt& t : tilts) {
    const bool to_left = t.angle > 0.0;
    const double before = phases.empty() ? 0.0 : phases.back().to;
    phases.push_back({to_left ? "to the left" : "to the right", before, t.time});
    said += format(
        "%s%.0f\xC2\xB0 to the %s at %.1f s: lower hand %.2f N, up to %.2f from %.2f upright, upper hand "
        "%.2f N",
        said.empty() ? "" : "; ", glm::degrees(std::abs(t.angle)), to_left ? "left" : "right", t.time,
        t.force.lower, t.force.top, t.force.upright, t.force.upper);
    torques += format("%s%.2f and %.2f (the lower's %.2f upright)", torques.empty() ? "" : "; ",
                      t.middle.lower, t.middle.upper, t.middle.upright);
    force_rises &= t.force.rises();
    middle_rises &= t.middle.rises();
    handle_rises &= t.handle.rises();
    lower_more &= t.force.lower > t.force.upper;
    middle_more &= t.middle.lower > t.middle.upper;
    handle_more &= t.handle.lower > kSame * t.handle.upper;
  }
  if (!phases.empty()) phases.push_back({"back", phases.back().to, time.back()});
  for (ChartPanel& panel : parts.panels) mark_phases(panel, phases);
  const Reading down = [](const Wrench& w) { return -w.force.y; };
  const double tenth = 0.1 * time.back();
  const Phase first{"", 0.0, tenth}, last{"", time.back() - 0.2, time.back()};
  const double before = mean(left, first, down) + mean(right, first, down);
  const double after = mean(left, last, down) + mean(right, last, down);
  const double torque_before = mean(left_about, first, torque_size) + mean(right_about, first, torque_size);
  const double torque_after = mean(left_about, last, torque_size) + mean(right_about, last, torque_size);
  parts.claims = {
      {"the bucket is tilted to the left, to the right, and then to the left again",
       format("%zu tilts", tilts.size()),
       tilts.size() == 3 && tilts[0].angle > 0.0 && tilts[1].angle < 0.0 && tilts[2].angle > 0.0},
      {"increasing the force on the side to which the bucket is tilted", said, force_rises && lower_more},
      {"and the torque on the side to which the bucket is tilted",
       format("about the bucket's centre of mass, where the paper sums it, lower and upper hand %s "
              "N\xC2\xB7m: the "
              "lower's %s the larger, and %s than upright%s; about its handle %s: up to %.2f N\xC2\xB7m, %s",
              torques.c_str(), middle_more ? "is" : "is not", middle_rises ? "more" : "no more",
              middle_rises ? "" : ", as a tilt shortens both arms",
              handle_rises ? "each tilt raises it" : "not every tilt raises it", left_top,
              one_curve ? "in both hands alike, as one bucket turns two alike springs"
                        : "not alike in both hands"),
       (middle_rises && middle_more) || (handle_rises && handle_more)},
      {"forces and torques progressively decrease as fluid is spilled",
       format("both hands together carry %.2f N at first and %.2f N at the end; their torques about the "
              "bucket's "
              "middle are %.2f and %.2f N\xC2\xB7m",
              before, after, torque_before, torque_after),
       after < (1.0 - kVisible) * before && torque_after < (1.0 - kVisible) * torque_before}};
  return parts;
}

}  // namespace slosh
