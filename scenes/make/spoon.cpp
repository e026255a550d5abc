// A spoon stands upright in a tank and is drawn forward and backward three times.
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/make/motion.h"
#include "scenes/make/shipped.h"

namespace slosh::make {
namespace {

const glm::dvec3 kSpoonInner(0.300, 0.110, 0.140);
constexpr double kSpoonFluidDepth = 0.075;
constexpr double kSpoonLift = 0.016;  ///< of the bowl over the tank's floor
constexpr double kBowlLength = 0.050;
constexpr double kBowlWidth = 0.040;
constexpr double kBowlBack = 0.016;  ///< how far the round back stands out
constexpr double kBowlDent = 0.003;  ///< how deep the front is
constexpr double kSpoonHandleRadius = 0.006;
constexpr double kHandleLength = 0.220;
constexpr double kGripHeight = 0.245;  ///< over the bowl's tip
constexpr double kStroke = 0.080;
constexpr double kSpoonDuration = 10.0;

/// The bowl as a lens of radius 1 sideways: full behind (−y), a little hollow in front. A superellipse of
/// power 3 keeps it thick up to the edge.
Solid lens() {
  std::vector<glm::dvec2> profile;
  for (int i = 0; i <= 14; ++i) {
    const double angle = glm::half_pi<double>() * i / 14;
    profile.emplace_back(i == 0 ? 0.0 : std::pow(std::sin(angle), 2.0 / 3.0),
                         i == 14 ? 0.0 : -kBowlBack * std::pow(std::cos(angle), 2.0 / 3.0));
  }
  for (int i = 1; i <= 6; ++i) {
    const double r = 1.0 - i / 6.0;
    profile.emplace_back(i == 6 ? 0.0 : r, -kBowlDent * (1.0 - r * r));
  }
  return lathe(profile, 40);
}

Solid spoon() {
  // The lens' axis turns to x, so that the broad side leads; its long side stands along y.
  glm::dmat4 place = glm::translate(glm::dmat4(1.0), glm::dvec3(0.5 * kBowlBack, 0.5 * kBowlLength, 0.0));
  place = place * glm::dmat4(glm::dmat3(glm::dvec3(0.0, 0.5 * kBowlLength, 0.0), glm::dvec3(1.0, 0.0, 0.0),
                                        glm::dvec3(0.0, 0.0, -0.5 * kBowlWidth)));
  const double foot = kBowlLength - 0.004;
  const Solid handle = capsule(kSpoonHandleRadius, foot, foot + kHandleLength, 10, 24);
  return merged(transformed(lens(), place), handle);
}

Pose spoon_pose(double time) {
  const double x = follow({{1.0, 0.0},
                           {1.6, kStroke},
                           {2.8, -kStroke},
                           {4.0, kStroke},
                           {5.2, -kStroke},
                           {6.4, kStroke},
                           {7.6, -kStroke},
                           {8.4, 0.0}},
                          time);
  return {{x, kWall + kSpoonLift, 0.0}, {1.0, 0.0, 0.0, 0.0}};
}

}  // namespace

SceneWriter make_spoon() {
  SceneWriter writer({{"title", "A spoon stirs a tank forward and backward (6.4.1)"},
                      {"spacing_min_m", 0.006},
                      {"spacing_max_m", 0.012},
                      {"duration_s", kSpoonDuration},
                      {"still_s", 2.0},
                      {"settle_s", kSettle},
                      {"domain_min_m", list({-0.40, -0.15, -0.30})},
                      {"domain_max_m", list({0.40, 0.55, 0.30})}});
  add_table(writer, 0.6, 0.4);
  const int clear = writer.add_material("clear plastic", {{0.75, 0.82, 0.85, 0.30}, 0.0, 0.15});
  const int steel = writer.add_material("steel", {{0.62, 0.63, 0.65, 1.0}, 1.0, 0.30});
  const int look = writer.add_material("juice", {{0.80, 0.30, 0.05, 0.6}, 0.0, 0.1});
  writer.add_node("tank", writer.add_mesh("tank", tank(kSpoonInner, kWall), clear), {},
                  {{"slosh", "body"}, {"motion", "fixed"}, {"viscosity_pa_s", 0.0}});
  const Solid fluid = box({-0.5 * kSpoonInner.x, kWall, -0.5 * kSpoonInner.z},
                          {0.5 * kSpoonInner.x, kWall + kSpoonFluidDepth, 0.5 * kSpoonInner.z});
  writer.add_node("juice", writer.add_mesh("juice", fluid, look), {},
                  {{"slosh", "fluid"},
                   {"density_kg_m3", 1000.0},
                   {"viscosity_pa_s", 0.1},
                   {"color", list({0.85, 0.35, 0.06})},
                   {"extinction_per_m", list({3.0, 9.0, 25.0})},
                   {"scattering", 0.5},
                   {"refraction", 1.35}});
  const int node = writer.add_node(
      "spoon", writer.add_mesh("spoon", spoon(), steel), spoon_pose(0.0),
      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.12}, {"viscosity_pa_s", 0.0}, {"friction", 0.3}});
  const Pose grip{{0.0, kGripHeight, 0.0}, {1.0, 0.0, 0.0, 0.0}};
  writer.add_node("spoon_hand", -1, grip,
                  {{"slosh", "grip"},
                   {"stiffness_n_m", 1500.0},
                   {"damping_n_s_m", 30.0},
                   {"rotational_stiffness_nm_rad", 15.0},
                   {"rotational_damping_nm_s_rad", 0.3},
                   {"device", 0}},
                  node);
  writer.add_hand(
      "spoon_motion", "spoon_hand", [=](double t) { return compose(spoon_pose(t), grip); }, kSpoonDuration);
  writer.add_camera({0.22, 0.34, 0.58}, {0.0, 0.11, 0.0}, 34.0);
  return writer;
}

}  // namespace slosh::make
