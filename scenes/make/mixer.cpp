// A whisk on a motor stirs a soup, in a bowl that a hand holds under it and moves about: the paper's
// discussion names it.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/make/kitchen.h"
#include "scenes/make/motion.h"

namespace slosh::make {
namespace {

constexpr Bowl kSoupBowl{0.090, -0.100, -0.185};
constexpr double kSoupBelowRim = 0.030;
constexpr double kSoupHeld = 0.090;   ///< of the bowl's underside over the table
constexpr double kWhiskFoot = 0.122;  ///< of its lowest point over the table
constexpr double kBalloon = 0.088;    ///< height of its wires
constexpr double kWire = 0.005;       ///< their radius: thick, as walls are to be a spacing at least
constexpr double kHeadFoot = 0.285;   ///< of the motor's head
constexpr double kStandTop = 0.36;
constexpr double kMixerDuration = 20.0;

/// A wire in the plane z = 0: half round below, `wide` m to either side, and drawn in to the hub above, where
/// both its ends stand upright.
Solid loop(double wide, double low, double hub) {
  constexpr int kRound = 24, kDrawnIn = 12;
  std::vector<glm::dvec3> path;
  const double middle = low + wide;
  for (int i = 0; i < kDrawnIn; ++i) {
    const double v = static_cast<double>(i) / kDrawnIn;
    path.emplace_back(hub + (wide - hub) * 0.5 * (1.0 - std::cos(glm::pi<double>() * v)),
                      kBalloon + (middle - kBalloon) * v, 0.0);
  }
  for (int i = 0; i <= kRound; ++i) {
    const double angle = glm::pi<double>() * i / kRound;
    path.emplace_back(wide * std::cos(angle), middle - wide * std::sin(angle), 0.0);
  }
  for (int i = kDrawnIn; i-- > 0;)
    path.emplace_back(-path[static_cast<std::size_t>(i)].x, path[static_cast<std::size_t>(i)].y, 0.0);
  return tube(path, kWire, 16);
}

/// Two wires across each other, one below the other; the hub and the rod stand on their ends.
Solid balloon_whisk() {
  const glm::dmat4 across(0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1);
  const Solid wires = merged(loop(0.032, kWire, 0.012), transformed(loop(0.028, 3.4 * kWire, 0.012), across));
  const double rod = 0.007, hub = 0.019, top = kHeadFoot - 0.006 - kWhiskFoot;
  const std::vector<glm::dvec2> profile{{0.0, kBalloon},         {hub, kBalloon}, {hub, kBalloon + 0.018},
                                        {rod, kBalloon + 0.030}, {rod, top},      {0.0, top}};
  return merged(wires, lathe(profile, 32));
}

/// Foot, column, arm and the motor's head over the bowl.
Solid stand() {
  const Solid foot = box({-0.09, 0.0, -0.23}, {0.09, 0.022, -0.13});
  const Solid column = box({-0.022, 0.022, -0.21}, {0.022, kStandTop - 0.05, -0.165});
  const Solid arm = box({-0.034, kStandTop - 0.05, -0.21}, {0.034, kStandTop, 0.034});
  const std::vector<glm::dvec2> profile{
      {0.0, kHeadFoot}, {0.030, kHeadFoot}, {0.034, kStandTop - 0.05}, {0.0, kStandTop - 0.05}};
  return merged(merged(foot, column), merged(arm, lathe(profile, 40)));
}

/// Round under the whisk, twice the other way, down until it is out of the soup, up again, and aside.
Pose soup_pose(double time) {
  const double out = follow({{3.0, 0.0}, {4.0, 0.020}, {11.0, 0.020}, {12.0, 0.0}}, time);
  const double way = turned({4.0, 0.8, 5.2, -3.0}, time);
  const double down = follow({{12.5, 0.0}, {13.8, -0.075}, {14.8, -0.075}, {16.2, 0.0}}, time);
  const double lean = glm::radians(follow({{16.8, 0.0}, {17.6, 10.0}, {18.6, 10.0}, {19.4, 0.0}}, time));
  return {{out * std::cos(way), kSoupHeld + down, out * std::sin(way)},
          glm::angleAxis(lean, glm::dvec3(0.0, 0.0, 1.0))};
}

}  // namespace

SceneWriter make_mixer() {
  SceneWriter writer({{"title", "A whisk on a motor stirs a soup in a bowl that a hand holds"},
                      {"spacing_min_m", 0.006},
                      {"spacing_max_m", 0.009},
                      {"duration_s", kMixerDuration},
                      {"still_s", 6.0},
                      {"settle_s", kSettle},
                      {"domain_min_m", list({-0.45, -0.15, -0.40})},
                      {"domain_max_m", list({0.45, 0.60, 0.40})}});
  add_table(writer, 0.64, 0.54);
  const int green = writer.add_material("green glaze", {{0.12, 0.28, 0.16, 1.0}, 0.0, 0.25});
  const int steel = writer.add_material("steel", {{0.70, 0.70, 0.72, 1.0}, 1.0, 0.30});
  const int cream = writer.add_material("enamel", {{0.78, 0.72, 0.60, 1.0}, 0.0, 0.30});
  const int look = writer.add_material("soup", {{0.85, 0.28, 0.05, 1.0}, 0.0, 0.5});
  const int bowl_node =
      writer.add_node("bowl_body", writer.add_mesh("bowl", kSoupBowl.solid(), green), soup_pose(0.0),
                      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.6}, {"viscosity_pa_s", 0.0}});
  writer.add_node("stand", writer.add_mesh("stand", stand(), cream), {},
                  {{"slosh", "body"}, {"motion", "fixed"}, {"viscosity_pa_s", 0.0}});
  const int whisk_node = writer.add_node(
      "whisk", writer.add_mesh("whisk", balloon_whisk(), steel),
      {{0.0, kWhiskFoot, 0.0}, {1.0, 0.0, 0.0, 0.0}},
      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.12}, {"friction", 0.1}, {"measured", true}});
  writer.add_node(
      "motor", -1, {{0.0, kHeadFoot - kWhiskFoot, 0.0}, {1.0, 0.0, 0.0, 0.0}},
      {{"slosh", "joint"}, {"kind", "hinge"}, {"to", "stand"}, {"motor_nm", 0.02}, {"motor_rad_s", 12.0}},
      whisk_node);
  writer.add_node("soup", writer.add_mesh("soup", kSoupBowl.filling(kSoupBelowRim), look), soup_pose(0.0),
                  {{"slosh", "fluid"},
                   {"density_kg_m3", 1030.0},
                   {"viscosity_pa_s", 3.0},
                   {"color", list({0.88, 0.28, 0.035})},
                   {"extinction_per_m", list({200.0, 260.0, 420.0})},
                   {"scattering", 1.0},
                   {"refraction", 1.36},
                   {"gloss", 0.8},
                   {"roughness", 0.25}});
  add_held(writer, "bowl", bowl_node, {{-0.160, kSoupBowl.bar_height(), 0.0}, {1.0, 0.0, 0.0, 0.0}}, 0,
           soup_pose, kMixerDuration);
  writer.add_node("bowl_inside", writer.add_mesh("bowl_inside", kSoupBowl.filling(0.0), look), {},
                  {{"slosh", "region"}}, bowl_node);
  writer.add_camera({0.30, 0.46, 0.56}, {-0.02, 0.18, -0.02}, 33.0);
  return writer;
}

}  // namespace slosh::make
