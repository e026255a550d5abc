// A curved probe is led by hand through a branching vessel in which fluid flows round in pulses: the paper's
// discussion names probes in vessels.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/make/motion.h"
#include "scenes/make/shipped.h"

namespace slosh::make {
namespace {

// A phantom as training uses it, some ten times as large as an artery. Its plan is upright, x and y: the
// trunk runs down and parts into a wide branch to the left and a narrow one to the right; a channel under
// both and one up at the right lead back to the open reservoir on top.
constexpr double kVesselHalfDepth = 0.026;  ///< of all channels, in z
constexpr double kPaneThickness = 0.021;
constexpr double kVesselFloor = 0.014, kUnderBranches = 0.058, kParting = 0.190;
constexpr double kTrunkTop = 0.265, kVesselLevel = 0.307, kVesselRim = 0.330;
constexpr double kTrunkHalf = 0.0289;   ///< of the trunk, and of the wide branch along x
constexpr double kNarrowHalf = 0.0219;  ///< of the narrow branch along x
constexpr double kLean = 0.5774;        ///< of both branches: dx over dy
constexpr double kVesselLeft = -0.125, kVesselRight = 0.220;
constexpr double kReturnFrom = 0.148, kReturnTo = 0.200;
constexpr double kVesselCorner = 0.006;  ///< radius

// The pump: a screw of two starts in the channel that leads back.
constexpr double kScrewFoot = 0.072, kScrewTop = 0.255;
constexpr double kScrewPitch = 0.130;
constexpr double kScrewMean = 0.0130, kScrewLobe = 0.0070;  ///< radius: mean, and what the lobes add
constexpr double kScrewShaft = 0.007;
constexpr double kScrewShaftTop = 0.318;
constexpr double kScrewPeriod = 2.0;  ///< s: twelve turns, two beats
constexpr int kScrewTurns = 12;
constexpr double kBeat = 2.7;  ///< rad ahead and behind the steady turn

// The probe: a straight shaft along its y from 0 on, an arc below it, and a ball at the arc's end.
constexpr double kCatheterRadius = 0.006, kTipRadius = 0.008;
constexpr double kCatheterShaft = 0.25, kCatheterHandle = 0.08;
constexpr double kCatheterBend = 0.095;
const double kCatheterBendAngle = glm::radians(30.0);
constexpr double kTipDeepest = 0.095;  ///< height of the rings, to which the ball is led
constexpr double kVesselDuration = 22.0;

using Outline = std::vector<glm::dvec2>;

double cross_of(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// The triangles of a polygon (counter-clockwise), its ears cut off one after the other.
std::vector<glm::uvec3> ears(const Outline& outline) {
  std::vector<unsigned> left;
  for (unsigned i = 0; i < outline.size(); ++i) left.push_back(i);
  std::vector<glm::uvec3> out;
  for (std::size_t i = 0; left.size() > 2;) {
    const std::size_t count = left.size();
    const unsigned a = left[(i + count - 1) % count], b = left[i % count], c = left[(i + 1) % count];
    const glm::dvec2 &pa = outline[a], &pb = outline[b], &pc = outline[c];
    bool ear = cross_of(pb - pa, pc - pb) > 0.0;
    for (const unsigned other : left) {
      const glm::dvec2& p = outline[other];
      if (other != a && other != b && other != c && cross_of(pb - pa, p - pa) >= 0.0 &&
          cross_of(pc - pb, p - pb) >= 0.0 && cross_of(pa - pc, p - pc) >= 0.0)
        ear = false;
    }
    if (!ear) {
      i = (i + 1) % count;
      continue;
    }
    out.emplace_back(a, b, c);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i % count));
    i = i % left.size();
  }
  return out;
}

/// A polygon (counter-clockwise) drawn out along z.
Solid prism(const Outline& outline, double back, double front) {
  Solid out;
  const auto count = static_cast<unsigned>(outline.size());
  for (const double z : {back, front})
    for (const glm::dvec2& p : outline) out.points.emplace_back(p, z);
  for (const glm::uvec3& t : ears(outline)) {
    out.triangles.emplace_back(t.z, t.y, t.x);
    out.triangles.push_back(t + count);
  }
  for (unsigned i = 0; i < count; ++i) {
    const unsigned j = (i + 1) % count;
    out.triangles.emplace_back(i, j, j + count);
    out.triangles.emplace_back(i, j + count, i + count);
  }
  return out;
}

Solid wall_of(const Outline& outline) {
  return prism(round_corners(outline, kVesselCorner, 3), -kVesselHalfDepth, kVesselHalfDepth);
}

double branch_shift(double y) {
  return kLean * (kParting - y);
}

/// Where the two branches part: their inner sides meet.
glm::dvec2 carina() {
  const double down = 0.5 * (kTrunkHalf + kNarrowHalf) / kLean;
  return {kTrunkHalf - kLean * down, kParting - down};
}

/// Where the narrow branch's outer side meets the trunk's.
glm::dvec2 narrow_shoulder() {
  return {kTrunkHalf, kParting - (kTrunkHalf - kNarrowHalf) / kLean};
}

Solid vessel_walls() {
  const double shift = branch_shift(kUnderBranches), wide_end = -kTrunkHalf - shift;
  const Solid left = wall_of({{kVesselLeft, 0.0},
                              {wide_end, 0.0},
                              {wide_end, kUnderBranches},
                              {-kTrunkHalf, kParting},
                              {-kTrunkHalf, kTrunkTop},
                              {-0.060, kTrunkTop},
                              {-0.060, kVesselRim},
                              {kVesselLeft, kVesselRim}});
  const Solid between =
      wall_of({carina(), {kTrunkHalf - shift, kUnderBranches}, {shift - kNarrowHalf, kUnderBranches}});
  const Solid right = wall_of({{kNarrowHalf + shift, kUnderBranches},
                               {kReturnFrom, kUnderBranches},
                               {kReturnFrom, kTrunkTop},
                               {kTrunkHalf, kTrunkTop},
                               narrow_shoulder()});
  const Solid side =
      box({kReturnTo, kVesselFloor, -kVesselHalfDepth}, {kVesselRight, kVesselRim, kVesselHalfDepth});
  const Solid floor = box({wide_end, 0.0, -kVesselHalfDepth}, {kVesselRight, kVesselFloor, kVesselHalfDepth});
  return merged(merged(merged(left, between), merged(right, side)), floor);
}

Solid pane(double from) {
  return box({kVesselLeft, 0.0, from}, {kVesselRight, kVesselRim, from + kPaneThickness});
}

/// What flows, side by side, each a closed part: all channels but where the contrast medium starts, and a
/// little apart from it, for the lattices of both are not one.
struct Filling {
  Solid blood, above, below;
};

Filling channels() {
  constexpr double kDeep = kVesselHalfDepth, kPlugFoot = 0.215, kPlugFrom = 0.0, kPlugTo = 0.060,
                   kPlugApart = 0.007;
  const auto part = [](const Outline& outline) { return prism(outline, -kDeep, kDeep); };
  const auto block = [](double left, double low, double right, double high) {
    return box({left, low, -kDeep}, {right, high, kDeep});
  };
  const double shift = branch_shift(kUnderBranches);
  const glm::dvec2 parts = carina();
  const Solid wide = part({{-kTrunkHalf - shift, kUnderBranches},
                           {kTrunkHalf - shift, kUnderBranches},
                           parts,
                           {parts.x, kPlugFoot - kPlugApart},
                           {-kTrunkHalf, kPlugFoot - kPlugApart},
                           {-kTrunkHalf, kParting}});
  const Solid narrow = part({{shift - kNarrowHalf, kUnderBranches},
                             {shift + kNarrowHalf, kUnderBranches},
                             narrow_shoulder(),
                             {kTrunkHalf, kPlugFoot - kPlugApart},
                             {parts.x, kPlugFoot - kPlugApart},
                             parts});
  const Solid under = merged(block(-kTrunkHalf - shift, kVesselFloor, kPlugFrom - kPlugApart, kUnderBranches),
                             block(kPlugTo + kPlugApart, kVesselFloor, kReturnTo, kUnderBranches));
  // Round the screw: what is in a body is left out, and much of it is told of.
  constexpr double kBeside = 0.014, kAt = 0.5 * (kReturnFrom + kReturnTo);
  const Solid sides = merged(block(kReturnFrom, kUnderBranches, kAt - kBeside, kTrunkTop),
                             block(kAt + kBeside, kUnderBranches, kReturnTo, kTrunkTop));
  const Solid ends =
      merged(box({kAt - kBeside, kUnderBranches, -kDeep}, {kAt + kBeside, kTrunkTop, -kBeside}),
             box({kAt - kBeside, kUnderBranches, kBeside}, {kAt + kBeside, kTrunkTop, kDeep}));
  const Solid back = merged(merged(sides, ends), block(-0.060, kTrunkTop, kReturnTo, kVesselLevel));
  return {merged(merged(wide, narrow), merged(under, back)),
          block(-kTrunkHalf, kPlugFoot, kTrunkHalf, kTrunkTop - kPlugApart),
          block(kPlugFrom, kVesselFloor, kPlugTo, kUnderBranches)};
}

/// A twisted rod whose section has two lobes, and the shaft that turns it; about y.
Solid screw() {
  constexpr int kAround = 32, kAlong = 72;
  Solid out;
  const auto ring = [&](double y, double mean, double lobe) {
    const double twist = glm::two_pi<double>() * (y - kScrewFoot) / kScrewPitch;
    for (int i = 0; i < kAround; ++i) {
      const double angle = glm::two_pi<double>() * i / kAround;
      const double r = mean + lobe * std::cos(2.0 * (angle - twist));
      out.points.emplace_back(r * std::cos(angle), y, r * std::sin(angle));
    }
  };
  int rings = kAlong + 1;
  for (int i = 0; i <= kAlong; ++i)
    ring(kScrewFoot + (kScrewTop - kScrewFoot) * i / kAlong, kScrewMean, kScrewLobe);
  for (const double y : {kScrewTop + 0.012, kScrewShaftTop}) ring(y, kScrewShaft, 0.0), ++rings;
  const auto at = [&](int r, int i) { return static_cast<unsigned>(r * kAround + i % kAround); };
  for (int r = 0; r + 1 < rings; ++r)
    for (int i = 0; i < kAround; ++i) {
      out.triangles.emplace_back(at(r, i), at(r + 1, i), at(r + 1, i + 1));
      out.triangles.emplace_back(at(r, i), at(r + 1, i + 1), at(r, i + 1));
    }
  const auto foot = static_cast<unsigned>(out.points.size());
  out.points.emplace_back(0.0, kScrewFoot, 0.0);
  out.points.emplace_back(0.0, kScrewShaftTop, 0.0);
  for (int i = 0; i < kAround; ++i) {
    out.triangles.emplace_back(foot, at(0, i), at(0, i + 1));
    out.triangles.emplace_back(foot + 1, at(rings - 1, i + 1), at(rings - 1, i));
  }
  return out;
}

Pose screw_pose(double time) {
  const double steady = glm::two_pi<double>() * kScrewTurns * time / kScrewPeriod;
  const double angle = steady - kBeat * std::sin(glm::two_pi<double>() * time);
  return {{0.5 * (kReturnFrom + kReturnTo), 0.0, 0.0}, glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0))};
}

/// The ball's centre in the probe's frame; the arc bends towards -x.
glm::dvec3 ball_at() {
  const double beyond = kTipRadius;
  return {-kCatheterBend * (1.0 - std::cos(kCatheterBendAngle)) - beyond * std::sin(kCatheterBendAngle),
          -kCatheterBend * std::sin(kCatheterBendAngle) - beyond * std::cos(kCatheterBendAngle), 0.0};
}

Solid curved_probe() {
  constexpr int kStraight = 10, kBent = 12;
  std::vector<glm::dvec3> path;
  for (int i = kStraight; i > 0; --i) path.emplace_back(0.0, kCatheterShaft * i / kStraight, 0.0);
  for (int i = 0; i <= kBent; ++i) {
    const double angle = kCatheterBendAngle * i / kBent;
    path.emplace_back(-kCatheterBend * (1.0 - std::cos(angle)), -kCatheterBend * std::sin(angle), 0.0);
  }
  const double high = kCatheterShaft + kCatheterHandle;
  const Outline handle{{0.0, kCatheterShaft}, {0.012, kCatheterShaft}, {0.012, high}, {0.0, high}};
  return merged(tube(path, kCatheterRadius, 20), lathe(round_corners(handle, 0.004, 3), 32));
}

/// Down the trunk, into the wide branch, sidewards against its wall, back, turned, into the narrow branch,
/// out.
Pose catheter_pose(double time) {
  constexpr double kOut = 0.345, kBack = 0.215, kIn = kTipDeepest;
  const double y = follow({{1.0, kOut},
                           {3.0, kBack},
                           {3.4, kBack},
                           {6.0, kIn},
                           {10.0, kIn},
                           {12.0, kBack},
                           {14.0, kBack},
                           {16.6, kIn},
                           {18.2, kIn},
                           {21.2, kOut}},
                          time);
  const double turn = follow({{12.0, 0.0}, {14.0, glm::pi<double>()}}, time);
  const double press = follow({{7.6, 0.0}, {8.4, 1.0}, {9.0, 1.0}, {9.8, 0.0}}, time);
  // The ball keeps to the middle of the branch, and the shaft leans as far as it is in.
  const double in = std::clamp((kBack - y) / (kBack - kIn), 0.0, 1.0);
  const double side = std::cos(turn);
  const double lean = glm::radians(16.0) * in * in;
  const glm::dvec3 ball(
      -side * (branch_shift(std::min(y, kParting)) + 0.5 * std::abs(ball_at().x) * (1.0 - in)) -
          0.020 * press,
      y, -0.5 * ball_at().x * std::sin(turn));
  const glm::dquat rotation = glm::angleAxis(-side * lean, glm::dvec3(0.0, 0.0, 1.0)) *
                              glm::angleAxis(turn, glm::dvec3(0.0, 1.0, 0.0));
  return {ball - rotation * ball_at(), rotation};
}

/// A ring before the vessel and one behind it: their common centre is in the branch.
Solid marker() {
  Outline section;
  for (int i = 0; i < 16; ++i) {
    const double angle = glm::two_pi<double>() * i / 16;
    section.emplace_back(0.022 + 0.005 * std::cos(angle), 0.005 * std::sin(angle));
  }
  const Solid ring = lathe(section, 40);
  const double apart = kVesselHalfDepth + kPaneThickness + 0.0052;
  const auto standing = [&](double z) {
    return transformed(ring, glm::dmat4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, z, 1));
  };
  return merged(standing(apart), standing(-apart));
}

nlohmann::json vessel_steps() {
  using nlohmann::json;
  const auto near = [](const char* ring) {
    return json{{"distance_m", "tip"}, {"to", ring}, {"at_most", 0.012}};
  };
  const json gentle{{"force_n", "probe"}, {"at_most", 2.0}};
  return {{{"say", "Lead the probe down the trunk into the wide branch, its ball to the green ring."},
           {"hint", "With at most 2 N: its curve leads it where it points."},
           {"until", {{"all", json::array({near("green_ring"), gentle})}}},
           {"hold_s", 0.5}},
          {{"say", "Press the ball against the branch's wall, with 1 to 4 N."},
           {"until", {{"force_n", "probe"}, {"at_least", 1.0}, {"at_most", 4.0}}},
           {"hold_s", 0.2}},
          {{"say", "Draw it back to where the branches part, turn it, and lead it to the yellow ring."},
           {"hint", "With at most 2 N."},
           {"until", {{"all", json::array({near("yellow_ring"), gentle})}}},
           {"hold_s", 0.5}},
          {{"say", "Draw it out."},
           {"until", {{"distance_m", "tip"}, {"to", "yellow_ring"}, {"at_least", 0.22}}}}};
}

nlohmann::json vessel_fluid(const glm::dvec3& color, const glm::dvec3& extinction) {
  return {{"density_kg_m3", 1060.0}, {"viscosity_pa_s", 0.3},
          {"color", list(color)},    {"extinction_per_m", list(extinction)},
          {"scattering", 0.25},      {"refraction", 1.36}};
}

}  // namespace

SceneWriter make_vessel() {
  const nlohmann::json fluids{{"contrast", vessel_fluid({0.10, 0.12, 0.60}, {30.0, 22.0, 6.0})},
                              {"blood", vessel_fluid({0.80, 0.05, 0.035}, {1.0, 13.0, 15.0})}};
  SceneWriter writer({{"title", "A curved probe is led into the branches of a vessel in which fluid flows"},
                      {"spacing_min_m", 0.006},
                      {"spacing_max_m", 0.010},
                      {"duration_s", kVesselDuration},
                      {"still_s", 7.0},
                      {"settle_s", kSettle},
                      {"fluids", fluids},
                      {"task", vessel_steps()},
                      {"domain_min_m", list({-0.30, -0.15, -0.25})},
                      {"domain_max_m", list({0.40, 0.65, 0.25})}});
  add_table(writer, 0.64, 0.40);
  const int cream = writer.add_material("silicone", {{0.80, 0.74, 0.66, 1.0}, 0.0, 0.5});
  const int white = writer.add_material("white", {{0.85, 0.85, 0.83, 1.0}, 0.0, 0.6});
  const int clear = writer.add_material("glass", {{0.85, 0.92, 0.94, 0.12}, 0.0, 0.05});
  const int steel = writer.add_material("steel", {{0.70, 0.70, 0.72, 1.0}, 1.0, 0.30});
  const int bright = writer.add_material("bright plastic", {{0.10, 0.72, 0.80, 1.0}, 0.0, 0.35});
  const int gold = writer.add_material("gold", {{0.95, 0.70, 0.20, 1.0}, 1.0, 0.25});
  const int green = writer.add_material("green", {{0.05, 0.50, 0.12, 1.0}, 0.0, 0.4});
  const int yellow = writer.add_material("yellow", {{0.85, 0.60, 0.03, 1.0}, 0.0, 0.4});
  const int look = writer.add_material("blood", {{0.70, 0.08, 0.05, 0.6}, 0.0, 0.3});
  const nlohmann::json fixed{{"slosh", "body"}, {"motion", "fixed"}, {"friction", 0.1}};
  writer.add_node("walls", writer.add_mesh("walls", vessel_walls(), cream), {}, fixed);
  writer.add_node("back", writer.add_mesh("back", pane(-kVesselHalfDepth - kPaneThickness), white), {},
                  fixed);
  writer.add_node("glass", writer.add_mesh("glass", pane(kVesselHalfDepth), clear), {}, fixed);
  const int pump = writer.add_node("screw", writer.add_mesh("screw", screw(), steel), screw_pose(0.0),
                                   {{"slosh", "body"}, {"motion", "driven"}, {"repeat", true}});
  writer.animate(pump, screw_pose, kScrewPeriod);

  const Pose start = catheter_pose(0.0);
  const int probe = writer.add_node(
      "probe_body", writer.add_mesh("probe", curved_probe(), bright), start,
      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.06}, {"friction", 0.1}, {"measured", true}});
  const int tip = writer.add_node(
      "tip", writer.add_mesh("tip", sphere(kTipRadius, 14, 28), gold),
      compose(start, Pose{ball_at(), {1.0, 0.0, 0.0, 0.0}}),
      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.01}, {"friction", 0.1}, {"measured", true}});
  writer.add_node("tip_joint", -1, {}, {{"slosh", "joint"}, {"kind", "fixed"}, {"to", "probe_body"}}, tip);
  const double ring_shift = branch_shift(kTipDeepest);
  const int ring = writer.add_mesh("green_ring", marker(), green);
  const int other = writer.add_mesh("yellow_ring", marker(), yellow);
  writer.add_node("green_ring", ring, {{-ring_shift, kTipDeepest, 0.0}, {1.0, 0.0, 0.0, 0.0}}, fixed);
  writer.add_node("yellow_ring", other, {{ring_shift, kTipDeepest, 0.0}, {1.0, 0.0, 0.0, 0.0}}, fixed);

  const Filling filling = channels();
  const nlohmann::json contrast{{"slosh", "fluid"}, {"fluid", "contrast"}};
  writer.add_node("contrast_above", writer.add_mesh("contrast_above", filling.above, look), {}, contrast);
  writer.add_node("contrast_below", writer.add_mesh("contrast_below", filling.below, look), {}, contrast);
  writer.add_node("blood", writer.add_mesh("blood", filling.blood, look), {},
                  {{"slosh", "fluid"}, {"fluid", "blood"}});
  const Pose grip{{0.0, kCatheterShaft + 0.5 * kCatheterHandle, 0.0}, {1.0, 0.0, 0.0, 0.0}};
  writer.add_node("probe", -1, grip,
                  {{"slosh", "grip"},
                   {"stiffness_n_m", 800.0},
                   {"damping_n_s_m", 20.0},
                   {"rotational_stiffness_nm_rad", 20.0},
                   {"rotational_damping_nm_s_rad", 0.5},
                   {"device", 0}},
                  probe);
  writer.add_hand(
      "probe_motion", "probe", [=](double t) { return compose(catheter_pose(t), grip); }, kVesselDuration);
  writer.add_camera({0.14, 0.36, 0.90}, {0.045, 0.215, 0.0}, 29.0);
  return writer;
}

}  // namespace slosh::make
