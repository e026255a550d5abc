// One particle on a 3-DoF device goes down into a tank and swipes sideways three times.
#include "scenes/make/motion.h"
#include "scenes/make/shipped.h"

namespace slosh::make {
namespace {

const glm::dvec3 kProbeInner(0.160, 0.100, 0.120);
constexpr double kProbeFluidDepth = 0.070;
constexpr double kAbove = kWall + kProbeFluidDepth + 0.035;
constexpr double kUnder = kWall + 0.5 * kProbeFluidDepth;
constexpr double kSwipe = 0.045;
constexpr double kProbeDuration = 8.0;

Pose probe_pose(double time) {
  const double y = follow({{1.0, kAbove}, {2.2, kUnder}, {6.4, kUnder}, {7.4, kAbove}}, time);
  const double x = follow(
      {{2.4, -kSwipe}, {3.6, kSwipe}, {3.8, kSwipe}, {5.0, -kSwipe}, {5.2, -kSwipe}, {6.4, kSwipe}}, time);
  return {{x, y, 0.0}, {1.0, 0.0, 0.0, 0.0}};
}

}  // namespace

SceneWriter make_probe() {
  SceneWriter writer({{"title", "One particle feels a fluid on a 3-DoF device (section 3)"},
                      {"spacing_min_m", 0.005},
                      {"spacing_max_m", 0.012},
                      {"duration_s", kProbeDuration},
                      {"still_s", 1.5},
                      {"settle_s", kSettle},
                      {"domain_min_m", list({-0.25, -0.15, -0.22})},
                      {"domain_max_m", list({0.25, 0.35, 0.22})}});
  add_table(writer, 0.5, 0.4, false);
  const int clear = writer.add_material("clear plastic", {{0.75, 0.82, 0.85, 0.30}, 0.0, 0.15});
  const int red = writer.add_material("red", {{0.80, 0.08, 0.05, 1.0}, 0.0, 0.4});
  const int look = writer.add_material("water", {{0.10, 0.35, 0.55, 0.5}, 0.0, 0.1});
  writer.add_node("tank", writer.add_mesh("tank", tank(kProbeInner, kWall), clear), {},
                  {{"slosh", "body"}, {"motion", "fixed"}, {"viscosity_pa_s", 0.0}});
  const Solid fluid = box({-0.5 * kProbeInner.x, kWall, -0.5 * kProbeInner.z},
                          {0.5 * kProbeInner.x, kWall + kProbeFluidDepth, 0.5 * kProbeInner.z});
  writer.add_node("water", writer.add_mesh("water", fluid, look), {},
                  {{"slosh", "fluid"},
                   {"density_kg_m3", 1000.0},
                   {"viscosity_pa_s", 0.05},
                   {"extinction_per_m", list({4.0, 1.2, 0.7})},
                   {"scattering", 0.3}});
  const int node = writer.add_node("probe", writer.add_mesh("probe", sphere(0.006, 12, 24), red),
                                   probe_pose(0.0), {{"slosh", "probe"}, {"mass_kg", 0.05}});
  writer.add_node("probe_hand", -1, {},
                  {{"slosh", "grip"},
                   {"stiffness_n_m", 500.0},
                   {"damping_n_s_m", 10.0},
                   {"rotational_stiffness_nm_rad", 0.0},
                   {"rotational_damping_nm_s_rad", 0.0},
                   {"device", 0}},
                  node);
  writer.add_hand("probe_motion", "probe_hand", probe_pose, kProbeDuration);
  writer.add_camera({0.17, 0.25, 0.42}, {0.0, 0.05, 0.0}, 32.0);
  return writer;
}

}  // namespace slosh::make
