// A crêpe: batter is stirred, poured into a hot pan, spread, pressed flat once it has set, and slid onto a
// plate, where a slice of butter that was cut meanwhile melts, and syrup is poured (paper, section 6.5).
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/make/kitchen.h"
#include "scenes/make/motion.h"

namespace slosh::make {
namespace {

// The bowl stands by the pan's left, and pours over its own lip.
constexpr double kMixRadius = 0.062;            ///< inner
constexpr double kMixRim = kMixRadius + kWall;  ///< height of the rim over the underside
constexpr double kMixBelowRim = 0.030;          ///< of the batter at the start
/// The milk falls onto it when the scene settles: particles that are too many for the batter's mesh lie on
/// it.
constexpr double kMilkAbove = 0.014, kMilkDepth = 0.032, kMilkRadius = 0.027;
constexpr double kMixHeld = 0.115;  ///< of the underside over the table
const glm::dvec3 kMixLip(-0.03, kMixHeld + kMixRim, 0.0);
// A shallow pan whose side leans outward.
constexpr double kCrepeRadius = 0.105;  ///< inner, of its floor
constexpr double kCrepeRim = 0.128, kCrepeDepth = 0.024;
constexpr double kCrepeHeld = 0.05;
constexpr double kHobTop = 0.04;
constexpr double kCrepeDuration = 38.5;
constexpr double kAtRest = 1.0;      ///< s that all hands hold still
constexpr double kPourBegins = 2.5;  ///< s that bowl and pan are behind their keys: the stirring takes longer

// What comes later hangs where a hand takes it.
const glm::dvec3 kSpatulaAt(0.02, 0.24, -0.2);
const glm::dvec3 kPlateAt(-0.31, 0.0, 0.0);
const glm::dvec3 kBoardAt(-0.12, 0.0, 0.2);
constexpr double kBoardTop = 0.012;
const glm::dvec3 kButterHalf(0.04, 0.012, 0.012);  ///< m, of the block's length, height and width
constexpr double kSlice = 0.014;                   ///< m of the block that is cut off
const glm::dvec3 kLadleAt(-0.415, 0.11, 0.0);
constexpr double kLadleBelowRim = 0.006;  ///< of the syrup

constexpr Bowl kMixingBowl{kMixRadius, -0.072, -0.15};
constexpr Bowl kLadle{0.034, -0.044, -0.11};

Solid falling_milk() {
  const double low = kMixRim - kMixBelowRim + kMilkAbove, high = low + kMilkDepth;
  return lathe({{0.0, low}, {kMilkRadius, low}, {kMilkRadius, high}, {0.0, high}}, 48);
}

Solid crepe_pan() {
  const double rise = kWall + kCrepeDepth;
  const std::vector<glm::dvec2> profile{
      {0.0, 0.0},        {kCrepeRadius + kWall, 0.0}, {kCrepeRim + kWall, rise},
      {kCrepeRim, rise}, {kCrepeRadius, kWall},       {0.0, kWall}};
  return merged(lathe(round_corners(profile, 0.004, 3), 72), bar(kCrepeRim + 0.004, 0.29, 0.024));
}

Solid pan_room() {
  const double low = kWall + 0.001, high = kWall + 0.05;
  return lathe(
      {{0.0, low}, {kCrepeRadius, low}, {kCrepeRim, kWall + kCrepeDepth}, {kCrepeRim, high}, {0.0, high}},
      48);
}

/// Four blades and a handle, side by side: parts that overlap would be told of.
Solid whisk() {
  const double low = 0.008, high = 0.06, wide = 0.022, half = 0.006;
  const Solid across = box({-wide, low, -half}, {wide, high, half});
  const Solid front = box({-half, low, half}, {half, high, wide}),
              back = box({-half, low, -wide}, {half, high, -half});
  const Solid rod = lathe({{0.0, high}, {half, high}, {half, 0.2}, {0.0, 0.2}}, 24);
  return merged(merged(across, rod), merged(front, back));
}

/// A blade with a handle that stands on it.
Solid spatula() {
  const double half = 0.03, thick = 0.012, rod = 0.006;
  return merged(box({-half, 0.0, -half}, {half, thick, half}),
                lathe({{0.0, thick}, {rod, thick}, {rod, 0.2}, {0.0, 0.2}}, 24));
}

/// A blade as thick as particles need, and a handle behind it.
Solid knife() {
  const double half = 0.06, high = 0.032, thick = 0.005;
  return merged(box({-half, 0.0, -thick}, {half, high, thick}),
                box({half, 0.014, -thick}, {half + 0.1, high, thick}));
}

Solid plate() {
  return lathe(
      round_corners(
          {{0.0, 0.0}, {0.08, 0.0}, {0.13, 0.022}, {0.13, 0.036}, {0.12, 0.034}, {0.08, 0.014}, {0.0, 0.014}},
          0.003, 3),
      72);
}

Pose mix_pose(double seconds) {
  const double time = seconds - kPourBegins;
  const double angle = glm::radians(follow({{6.6, 0.0}, {10.0, 95.0}, {12.0, 112.0}, {13.4, 0.0}}, time));
  const double up = follow({{12.4, 0.0}, {14.0, 0.12}}, time);
  const double aside = follow({{12.6, 0.0}, {14.2, -0.2}}, time);
  const glm::dquat turn = glm::angleAxis(-angle, glm::dvec3(0.0, 0.0, 1.0));
  const glm::dvec3 lip(kMixRadius + 0.5 * kWall, kMixRim, 0.0);
  return {kMixLip - turn * lip + glm::dvec3(0.0, up, aside), turn};
}

Pose whisk_pose(double seconds) {
  const double time = seconds - kAtRest;
  const glm::dvec3 middle = mix_pose(0.0).position + glm::dvec3(0.0, 0.012, 0.0);
  const double around = turned({1.0, 0.6, 4.7, 9.0}, time);
  const double out = follow({{1.0, 0.0}, {1.6, 0.013}, {6.3, 0.013}, {6.9, 0.0}}, time);
  const double up =
      follow({{0.0, 0.12}, {1.2, 0.006}, {2.4, 0.016}, {3.6, 0.006}, {6.7, 0.006}, {7.9, 0.26}}, time);
  const double back = follow({{7.1, 0.0}, {8.1, -0.22}}, time);
  return {middle + glm::dvec3(out * std::cos(around), up, out * std::sin(around) + back),
          {1.0, 0.0, 0.0, 0.0}};
}

Pose pan_pose(double seconds) {
  const double time = seconds - kPourBegins;
  // Tilted once round, to let the batter run; later up, over to the plate, and on its side.
  const double lean = glm::radians(follow({{11.5, 0.0}, {12.2, 2.5}, {14.6, 2.5}, {15.4, 0.0}}, time));
  const double way = turned({11.5, 0.6, 2.4, 1.5 * glm::pi<double>() / 2.5}, time);
  const double over = glm::radians(follow({{21.0, 0.0}, {23.5, 75.0}, {24.5, 75.0}, {26.0, 0.0}}, time));
  const glm::dquat round = glm::angleAxis(lean, glm::dvec3(std::cos(way), 0.0, std::sin(way)));
  const glm::dquat turn = glm::angleAxis(over, glm::dvec3(0.0, 0.0, 1.0)) * round;
  const double up =
      follow({{11.2, 0.0}, {11.8, 0.03}, {15.0, 0.03}, {15.8, 0.0}, {19.5, 0.0}, {21.0, 0.12}}, time);
  const double to_plate = follow({{20.0, 0.0}, {21.5, -0.145}, {24.5, -0.145}, {26.5, 0.05}}, time);
  return {{to_plate, kCrepeHeld + up, 0.0}, turn};
}

Pose spatula_pose(double time) {
  const double floor = kCrepeHeld + kWall;
  const double along = follow({{17.5, 0.0}, {19.0, 1.0}, {21.4, 1.0}, {22.6, 0.0}}, time);
  const double down = follow({{19.0, 0.06}, {20.0, -0.006}, {20.8, -0.006}, {21.4, 0.06}}, time);
  const glm::dvec3 over_pan(0.02, floor + down, 0.0);
  return {glm::mix(kSpatulaAt, over_pan, along), {1.0, 0.0, 0.0, 0.0}};
}

/// Down through the butter, its edge across it, the handle towards the person; then aside with the slice.
Pose knife_pose(double time) {
  const double up = follow({{14.6, 0.11}, {15.2, 0.03}, {16.4, -0.006}, {17.4, -0.006}, {18.2, 0.11}}, time);
  const double aside = follow({{16.5, 0.0}, {17.2, -0.02}}, time);
  const glm::dvec3 over_slice(aside - kButterHalf.x + kSlice, kBoardTop + up, -0.03);
  return {kBoardAt + over_slice, glm::angleAxis(-glm::half_pi<double>(), glm::dvec3(0.0, 1.0, 0.0))};
}

Pose ladle_pose(double time) {
  const double angle = glm::radians(follow({{33.5, 0.0}, {35.0, 37.0}, {35.2, 37.0}, {36.2, 0.0}}, time));
  const glm::dquat turn = glm::angleAxis(-angle, glm::dvec3(0.0, 0.0, 1.0));
  const glm::dvec3 lip(kLadle.radius + 0.5 * kWall, kLadle.rim(), 0.0);
  return {kLadleAt + lip - turn * lip, turn};
}

nlohmann::json crepe_steps() {
  using nlohmann::json;
  const auto of = [](const char* kind, const char* region, double least) {
    return json{{kind, region}, {"at_least", least}};
  };
  const auto all = [](const json& a, const json& b) { return json{{"all", json::array({a, b})}}; };
  json mixed = of("mixing", "bowl_inside", 0.75);
  mixed["fluid"] = "milk";
  return {
      {{"say", "Stir the milk into the batter with the whisk."},
       {"hint", "Go round the bowl, down to its floor."},
       {"until", mixed}},
      {{"say", "Tilt the bowl over its lip, and pour into the pan."},
       {"hint", "Stop while some is left: the crêpe is to be thin."},
       {"until", of("mass_kg", "pan_inside", 0.2)}},
      {{"say", "Tilt the pan round until the batter covers it."},
       {"until", all(of("spread_m2", "pan_inside", 0.025), of("evenness", "pan_inside", 0.65))},
       {"hold_s", 1.5},
       {"then", json::array({{{"takes_away", "whisk_body"}},
                             {{"appears", "knife_body"}},
                             {{"hand", "whisk"}, {"takes", "knife"}}})}},
      {{"say", "While it sets, cut a slice off the butter with the knife."},
       {"hint", "Straight down, until the knife is on the board."},
       {"until", {{"pieces", "butter_block"}, {"at_least", 2}}},
       {"hold_s", 0.8},
       {"then", json::array({{{"takes_away", "knife_body"}},
                             {{"appears", "spatula_body"}},
                             {{"hand", "knife"}, {"takes", "spatula"}}})}},
      {{"say", "Let it set."},
       {"until", of("set", "pan_inside", 0.9)},
       {"then", json::array({{{"takes_away", "batter"}, {"in", "bowl_inside"}},
                             {{"takes_away", "milk"}, {"in", "bowl_inside"}},
                             {{"takes_away", "bowl_body"}}})}},
      {{"say", "Press it flat on the pan with the spatula."},
       {"hint", "With 2 to 10 N, for a moment."},
       {"until", {{"force_n", "spatula"}, {"at_least", 2.0}, {"at_most", 10.0}}},
       {"hold_s", 0.2}},
      {{"say", "Tilt the pan over the plate until the crêpe slides onto it."},
       {"until", of("mass_kg", "plate_top", 0.15)},
       {"then", json::array({{{"takes_away", "spatula_body"}},
                             {{"takes_away", "butter_block~2"}},
                             {{"appears", "butter"}}})}},
      {{"say", "Let the butter melt on it."},
       {"until", {{"set", "plate_top"}, {"fluid", "butter"}, {"at_most", 0.4}}},
       {"then", json::array({{{"appears", "ladle_body"}},
                             {{"appears", "syrup"}},
                             {{"hand", "spatula"}, {"takes", "ladle"}}})}},
      {{"say", "Pour 20 to 60 g of syrup on it, and set the ladle upright."},
       {"until", all({{"mass_kg", "plate_top"}, {"fluid", "syrup"}, {"at_least", 0.02}, {"at_most", 0.06}},
                     {{"tilt_deg", "ladle_body"}, {"at_most", 10.0}})},
       {"hold_s", 0.5}}};
}

nlohmann::json crepe_batter(const char* name, double viscosity, const glm::dvec3& color) {
  return {{"slosh", "fluid"},
          {"fluid", name},
          {"density_kg_m3", 1050.0},
          {"viscosity_pa_s", viscosity},
          {"color", list(color)},
          {"extinction_per_m", list({250.0, 280.0, 400.0})},
          {"scattering", 1.0},
          {"refraction", 1.4},
          {"gloss", 0.8},
          {"roughness", 0.4},
          // As thick as a few particles are, it is some five times as thick as a crêpe, and would take 25
          // times as long to set.
          {"heat_capacity_j_kg_k", 3300.0},
          {"conductivity_w_m_k", 6.0},
          {"sets_above_c", 75.0},
          {"sets_in_s", 3.0},
          {"set_viscosity_pa_s", 40.0},
          {"set_modulus_pa", 8000.0},
          {"tears_at", 0.6}};
}

nlohmann::json crepe_butter() {
  return {{"slosh", "fluid"},
          {"fluid", "butter"},
          {"density_kg_m3", 910.0},
          {"viscosity_pa_s", 0.3},
          {"color", list({0.98, 0.86, 0.42})},
          {"extinction_per_m", list({120.0, 140.0, 260.0})},
          {"scattering", 0.9},
          {"refraction", 1.46},
          {"temperature_c", 15.0},
          {"heat_capacity_j_kg_k", 2200.0},
          {"conductivity_w_m_k", 10.0},
          {"starts_set", true},
          {"starts_away", true},
          {"set_viscosity_pa_s", 20.0},
          {"set_modulus_pa", 7000.0},
          {"melts_above_c", 28.0},
          {"melts_in_s", 1.5}};
}

nlohmann::json crepe_syrup() {
  return {{"slosh", "fluid"},
          {"fluid", "syrup"},
          {"density_kg_m3", 1300.0},
          {"viscosity_pa_s", 0.4},
          {"color", list({0.45, 0.16, 0.02})},
          {"extinction_per_m", list({20.0, 70.0, 250.0})},
          {"refraction", 1.49},
          {"conductivity_w_m_k", 0.4},
          {"heat_capacity_j_kg_k", 2600.0},
          {"starts_away", true}};
}

}  // namespace

SceneWriter make_crepe() {
  SceneWriter writer({{"title", "A crêpe is stirred, poured, spread, baked and served (6.5)"},
                      {"spacing_min_m", 0.006},
                      {"spacing_max_m", 0.009},
                      {"duration_s", kCrepeDuration},
                      {"still_s", 37.5},
                      {"settle_s", kSettle},
                      {"task", crepe_steps()},
                      {"domain_min_m", list({-0.55, -0.15, -0.4})},
                      {"domain_max_m", list({0.5, 0.75, 0.4})}});
  add_table(writer, 0.9, 0.6);
  const int blue = writer.add_material("blue glaze", {{0.10, 0.22, 0.45, 1.0}, 0.0, 0.25});
  const int iron = writer.add_material("cast iron", {{0.06, 0.06, 0.07, 1.0}, 0.7, 0.50});
  const int steel = writer.add_material("steel", {{0.70, 0.70, 0.72, 1.0}, 1.0, 0.30});
  const int white = writer.add_material("china", {{0.85, 0.84, 0.80, 1.0}, 0.0, 0.20});
  const int hot = writer.add_material("hob", {{0.05, 0.05, 0.05, 1.0}, 0.0, 0.30, {0.5, 0.06, 0.01}});
  const int look = writer.add_material("batter", {{0.90, 0.78, 0.42, 1.0}, 0.0, 0.6});
  const nlohmann::json free_body{
      {"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.5}, {"viscosity_pa_s", 0.0}};
  const int bowl_node = writer.add_node("bowl_body", writer.add_mesh("bowl", kMixingBowl.solid(), blue),
                                        mix_pose(0.0), free_body);
  nlohmann::json pan_body = free_body;
  pan_body.erase("viscosity_pa_s");
  pan_body["slip"] = true;
  pan_body["mass_kg"] = 0.8;
  pan_body["temperature_c"] = 190.0;
  const int pan_node =
      writer.add_node("pan_body", writer.add_mesh("pan", crepe_pan(), iron), pan_pose(0.0), pan_body);
  nlohmann::json whisk_body = free_body;
  whisk_body["mass_kg"] = 0.15;
  const int whisk_node =
      writer.add_node("whisk_body", writer.add_mesh("whisk", whisk(), steel), whisk_pose(0.0), whisk_body);
  writer.add_node(
      "hob", writer.add_mesh("hob", lathe({{0.0, 0.0}, {0.1, 0.0}, {0.1, kHobTop}, {0.0, kHobTop}}, 48), hot),
      {}, {{"slosh", "body"}, {"viscosity_pa_s", 0.0}});
  const int plate_node =
      writer.add_node("plate", writer.add_mesh("plate", plate(), white), {kPlateAt, {1.0, 0.0, 0.0, 0.0}},
                      {{"slosh", "body"}, {"viscosity_pa_s", 0.0}, {"temperature_c", 30.0}});
  nlohmann::json spatula_body = free_body;
  spatula_body["mass_kg"] = 0.06;
  spatula_body["starts_away"] = true;
  const int spatula_node = writer.add_node("spatula_body", writer.add_mesh("spatula", spatula(), steel),
                                           spatula_pose(0.0), spatula_body);
  const int wood = writer.add_material("beech", {{0.62, 0.42, 0.24, 1.0}, 0.0, 0.55});
  const int fat = writer.add_material("butter", {{0.96, 0.82, 0.36, 1.0}, 0.0, 0.45});
  writer.add_node("board",
                  writer.add_mesh("board", box({-0.075, 0.0, -0.045}, {0.075, kBoardTop, 0.045}), wood),
                  {kBoardAt, {1.0, 0.0, 0.0, 0.0}}, {{"slosh", "body"}, {"viscosity_pa_s", 0.0}});
  writer.add_node("butter_block", writer.add_mesh("butter_block", box(-kButterHalf, kButterHalf), fat),
                  {kBoardAt + glm::dvec3(0.0, kBoardTop + kButterHalf.y, 0.0), {1.0, 0.0, 0.0, 0.0}},
                  {{"slosh", "body"},
                   {"motion", "free"},
                   {"density_kg_m3", 910.0},
                   {"viscosity_pa_s", 0.0},
                   {"pieces", 2},
                   {"cut_n_m", 150.0}});
  nlohmann::json knife_body = free_body;
  knife_body["mass_kg"] = 0.12;
  knife_body["starts_away"] = true;
  knife_body["blade"] = true;
  const int knife_node =
      writer.add_node("knife_body", writer.add_mesh("knife", knife(), steel), knife_pose(0.0), knife_body);
  nlohmann::json ladle_body = free_body;
  ladle_body["mass_kg"] = 0.2;
  ladle_body["starts_away"] = true;
  const int ladle_node = writer.add_node("ladle_body", writer.add_mesh("ladle", kLadle.solid(), blue),
                                         ladle_pose(0.0), ladle_body);
  const Pose in_bowl = mix_pose(0.0);
  writer.add_node("batter", writer.add_mesh("batter", kMixingBowl.filling(kMixBelowRim), look), in_bowl,
                  crepe_batter("batter", 2.5, {0.92, 0.76, 0.38}));
  writer.add_node("milk", writer.add_mesh("milk", falling_milk(), look), in_bowl,
                  crepe_batter("milk", 1.0, {0.95, 0.86, 0.62}));
  writer.add_node("butter", writer.add_mesh("butter", box(glm::dvec3(-0.01), glm::dvec3(0.01)), look),
                  {kPlateAt + glm::dvec3(-0.035, 0.09, 0.0), {1.0, 0.0, 0.0, 0.0}}, crepe_butter());
  writer.add_node("syrup", writer.add_mesh("syrup", kLadle.filling(kLadleBelowRim), look), {}, crepe_syrup(),
                  ladle_node);
  add_held(writer, "bowl", bowl_node, {{-0.12, kMixRim - 0.014, 0.0}, {1.0, 0.0, 0.0, 0.0}}, 0, mix_pose,
           kCrepeDuration);
  add_held(writer, "whisk", whisk_node, {{0.0, 0.17, 0.0}, {1.0, 0.0, 0.0, 0.0}}, 1, whisk_pose,
           kCrepeDuration);
  add_held(writer, "pan", pan_node, {{0.19, 0.024, 0.0}, {1.0, 0.0, 0.0, 0.0}}, 2, pan_pose, kCrepeDuration);
  add_held(writer, "spatula", spatula_node, {{0.0, 0.17, 0.0}, {1.0, 0.0, 0.0, 0.0}}, 3, spatula_pose,
           kCrepeDuration);
  add_held(writer, "knife", knife_node, {{0.09, 0.024, 0.0}, {1.0, 0.0, 0.0, 0.0}}, 5, knife_pose,
           kCrepeDuration);
  add_held(writer, "ladle", ladle_node, {{-0.09, kLadle.bar_height(), 0.0}, {1.0, 0.0, 0.0, 0.0}}, 4,
           ladle_pose, kCrepeDuration);
  writer.add_node("bowl_inside", writer.add_mesh("bowl_inside", kMixingBowl.filling(0.0), look), {},
                  {{"slosh", "region"}}, bowl_node);
  writer.add_node("pan_inside", writer.add_mesh("pan_inside", pan_room(), look), {}, {{"slosh", "region"}},
                  pan_node);
  writer.add_node("ladle_inside", writer.add_mesh("ladle_inside", kLadle.filling(0.0), look), {},
                  {{"slosh", "region"}}, ladle_node);
  writer.add_node(
      "plate_top",
      writer.add_mesh("plate_top", lathe({{0.0, 0.0141}, {0.13, 0.0141}, {0.13, 0.12}, {0.0, 0.12}}, 48),
                      look),
      {}, {{"slosh", "region"}}, plate_node);
  writer.add_camera({0.16, 0.62, 0.92}, {-0.06, 0.10, 0.0}, 38.0);
  return writer;
}

}  // namespace slosh::make
