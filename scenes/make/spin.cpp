// Four glasses of one fluid, their walls of rising viscosity, are spun up and stopped.
#include <glm/gtc/constants.hpp>

#include "scenes/make/motion.h"
#include "scenes/make/shipped.h"

namespace slosh::make {
namespace {

constexpr double kRadius = 0.045;  ///< inner
constexpr double kHeight = 0.100;  ///< inner
constexpr double kSpinFluidDepth = 0.090;
constexpr double kApart = 0.25;
constexpr double kSpinHeld = 0.03;  ///< clear of the table, which is only looked at: nothing rubs
constexpr int kViscosities[] = {2, 10, 20, 40};  // Pa·s
constexpr double kSpinDuration = 7.0;
constexpr Turn kSpinTurn{1.5, 0.15, 3.0, glm::two_pi<double>()};

Solid glass() {
  const double outer = kRadius + kWall;
  const double top = kWall + kHeight;
  return lathe(
      round_corners({{0.0, 0.0}, {outer, 0.0}, {outer, top}, {kRadius, top}, {kRadius, kWall}, {0.0, kWall}},
                    0.003, 3),
      64);
}

Solid syrup() {
  return lathe(
      {{0.0, kWall}, {kRadius, kWall}, {kRadius, kWall + kSpinFluidDepth}, {0.0, kWall + kSpinFluidDepth}},
      64);
}

}  // namespace

SceneWriter make_spin() {
  const nlohmann::json fluids = {{"syrup",
                                  {{"density_kg_m3", 1000.0},
                                   {"viscosity_pa_s", 2.0},
                                   {"color", list({0.70, 0.25, 0.04})},
                                   {"extinction_per_m", list({6.0, 20.0, 60.0})},
                                   {"scattering", 0.08},
                                   {"refraction", 1.49}}}};
  SceneWriter writer({{"title", "Four glasses with walls of 2, 10, 20 and 40 Pa·s spin up and stop (6.4.3)"},
                      {"spacing_min_m", 0.006},
                      {"spacing_max_m", 0.012},
                      {"duration_s", kSpinDuration},
                      {"still_s", 2.0},
                      {"settle_s", kSettle},
                      {"fluids", fluids},
                      {"domain_min_m", list({-0.65, -0.15, -0.25})},
                      {"domain_max_m", list({0.65, 0.40, 0.25})}});
  add_table(writer, 1.2, 0.5, false);
  const int clear = writer.add_material("glass", {{0.80, 0.90, 0.92, 0.25}, 0.0, 0.08});
  const int look = writer.add_material("syrup", {{0.70, 0.25, 0.04, 0.7}, 0.0, 0.1});
  const int glass_mesh = writer.add_mesh("glass", glass(), clear);
  const int syrup_mesh = writer.add_mesh("syrup", syrup(), look);
  for (int i = 0; i < 4; ++i) {
    const std::string number = std::to_string(kViscosities[i]);
    const glm::dvec3 at((i - 1.5) * kApart, kSpinHeld, 0.0);
    const Pose start{at, {1.0, 0.0, 0.0, 0.0}};
    const int node = writer.add_node("glass_" + number, glass_mesh, start,
                                     {{"slosh", "body"},
                                      {"motion", "free"},
                                      {"mass_kg", 0.15},
                                      {"viscosity_pa_s", static_cast<double>(kViscosities[i])}});
    writer.add_node("syrup_" + number, syrup_mesh, start, {{"slosh", "fluid"}, {"fluid", "syrup"}});
    writer.add_node("hand_" + number, -1, {},
                    {{"slosh", "grip"},
                     {"stiffness_n_m", 2000.0},
                     {"damping_n_s_m", 60.0},
                     {"rotational_stiffness_nm_rad", 40.0},
                     {"rotational_damping_nm_s_rad", 0.4},
                     {"device", i}},
                    node);
    const auto pose_at = [=](double t) {
      return Pose{at, glm::angleAxis(turned(kSpinTurn, t), glm::dvec3(0.0, 1.0, 0.0))};
    };
    // The start takes 0.15 s: keys close enough to keep its shape.
    writer.add_hand("motion_" + number, "hand_" + number, pose_at, kSpinDuration, 120.0);
  }
  writer.add_camera({-0.10, 0.42, 1.02}, {0.0, 0.05, 0.0}, 32.0);
  return writer;
}

}  // namespace slosh::make
