// Batter is poured from a bowl into a pan; each is held by a hand.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/make/kitchen.h"
#include "scenes/make/motion.h"

namespace slosh::make {
namespace {

constexpr double kBowlRadius = 0.075;             ///< inner
constexpr double kBowlRim = kBowlRadius + kWall;  ///< height of the rim over the underside
constexpr double kBelowRim = 0.015;               ///< of the batter at the start
constexpr double kBowlHeld = 0.21;                ///< of the underside over the table
constexpr double kPanRadius = 0.105;              ///< inner
constexpr double kPanDepth = 0.040;
constexpr double kPanHeld = 0.08;
/// Where the lip stays while the bowl tilts: the stream lands a little beyond, in the pan's middle.
const glm::dvec3 kLip(-0.03, kBowlHeld + kBowlRim, 0.0);
constexpr double kPourDuration = 10.0;

constexpr Bowl kBowl{kBowlRadius, -0.082, -0.165};

/// What is in the pan, and a little above its rim.
Solid pan_inside() {
  const double inner = kPanRadius - 0.001;
  const double low = kWall + 0.001, high = kWall + 1.5 * kPanDepth;
  return lathe({{0.0, low}, {inner, low}, {inner, high}, {0.0, high}}, 48);
}

nlohmann::json steps() {
  const auto in_pan = [](double kg) { return nlohmann::json{{"mass_kg", "pan_inside"}, {"at_least", kg}}; };
  const nlohmann::json upright{{"tilt_deg", "bowl_body"}, {"at_most", 15.0}};
  const nlohmann::json still{{"speed_m_s", "pan_body"}, {"at_most", 0.05}};
  return {{{"say", "Tilt the bowl until batter runs into the pan."},
           {"hint", "Turn the bowl about its lip, over the pan's middle."},
           {"until", in_pan(0.02)}},
          {{"say", "Pour until the pan holds 0.4 kg."},
           {"hint", "Tilt further: batter is thick, and takes its time."},
           {"until", in_pan(0.4)},
           {"within_s", 10.0}},
          {{"say", "Set the bowl upright, and hold the pan still."},
           {"until", {{"all", nlohmann::json::array({upright, still})}}},
           {"hold_s", 0.3}}};
}

Solid pan() {
  const double outer = kPanRadius + kWall;
  const std::vector<glm::dvec2> profile{
      {0.0, 0.0},          {outer, 0.0}, {outer, kWall + kPanDepth}, {kPanRadius, kWall + kPanDepth},
      {kPanRadius, kWall}, {0.0, kWall}};
  return merged(lathe(round_corners(profile, 0.004, 3), 72), bar(kPanRadius + 0.5 * kWall, 0.28, 0.036));
}

/// Turned about the lip, the +x side down.
Pose bowl_pose(double time) {
  const double angle = glm::radians(follow({{1.0, 0.0}, {4.0, 115.0}, {7.0, 115.0}, {9.4, 0.0}}, time));
  const glm::dquat turn = glm::angleAxis(-angle, glm::dvec3(0.0, 0.0, 1.0));
  const glm::dvec3 lip(kBowlRadius + 0.5 * kWall, kBowlRim, 0.0);  // in the bowl's frame
  return {kLip - turn * lip, turn};
}

}  // namespace

SceneWriter make_pour() {
  SceneWriter writer({{"title", "Batter is poured from a bowl into a pan (6.4.2)"},
                      {"spacing_min_m", 0.006},
                      {"spacing_max_m", 0.012},
                      {"duration_s", kPourDuration},
                      {"still_s", 2.2},
                      {"settle_s", kSettle},
                      {"task", steps()},
                      {"domain_min_m", list({-0.45, -0.15, -0.35})},
                      {"domain_max_m", list({0.50, 0.75, 0.35})}});
  add_table(writer, 0.7, 0.5);
  const int blue = writer.add_material("blue glaze", {{0.10, 0.22, 0.45, 1.0}, 0.0, 0.25});
  const int iron = writer.add_material("cast iron", {{0.06, 0.06, 0.07, 1.0}, 0.7, 0.50});
  const int look = writer.add_material("batter", {{0.90, 0.78, 0.42, 1.0}, 0.0, 0.6});
  const auto pan_pose = [](double) { return Pose{{0.0, kPanHeld, 0.0}, {1.0, 0.0, 0.0, 0.0}}; };
  const int bowl_node =
      writer.add_node("bowl_body", writer.add_mesh("bowl", kBowl.solid(), blue), bowl_pose(0.0),
                      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.5}, {"viscosity_pa_s", 0.0}});
  const int pan_node =
      writer.add_node("pan_body", writer.add_mesh("pan", pan(), iron), pan_pose(0.0),
                      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.7}, {"viscosity_pa_s", 0.0}});
  writer.add_node("batter", writer.add_mesh("batter", kBowl.filling(kBelowRim), look), bowl_pose(0.0),
                  {{"slosh", "fluid"},
                   {"density_kg_m3", 1100.0},
                   {"viscosity_pa_s", 1.5},
                   {"color", list({0.92, 0.76, 0.38})},
                   {"extinction_per_m", list({250.0, 280.0, 400.0})},
                   {"scattering", 1.0},
                   {"refraction", 1.4},
                   {"gloss", 0.8},
                   {"roughness", 0.4}});
  add_held(writer, "bowl", bowl_node, {{-0.13, kBowlRim - 0.014, 0.0}, {1.0, 0.0, 0.0, 0.0}}, 0, bowl_pose,
           kPourDuration);
  add_held(writer, "pan", pan_node, {{0.17, 0.036, 0.0}, {1.0, 0.0, 0.0, 0.0}}, 1, pan_pose, kPourDuration);
  writer.add_node("pan_inside", writer.add_mesh("pan_inside", pan_inside(), look), {}, {{"slosh", "region"}},
                  pan_node);
  writer.add_camera({0.21, 0.60, 0.84}, {0.01, 0.195, 0.0}, 35.0);
  return writer;
}

}  // namespace slosh::make
