// A pool of 1 m by 1 m, of any particle count; a ball goes round in it, half immersed.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/make/motion.h"
#include "scenes/make/paints.h"
#include "scenes/make/shipped.h"

namespace slosh::make {
namespace {

const glm::dvec3 kInner(1.0, 0.35, 1.0);
constexpr double kPoolWall = 0.060;
constexpr double kPoolFluidDepth = 0.25;
constexpr double kBallRadius = 0.080;
constexpr double kCircle = 0.25;  ///< radius of the ball's way
constexpr double kPoolDuration = 12.0;
constexpr Turn kPoolTurn{1.0, 1.0, 8.6, glm::two_pi<double>() / 4.8};  // two rounds in all

Pose ball_pose(double time) {
  const double angle = turned(kPoolTurn, time);
  return {{kCircle * std::cos(angle), kPoolWall + kPoolFluidDepth, -kCircle * std::sin(angle)},
          {1.0, 0.0, 0.0, 0.0}};
}

}  // namespace

SceneWriter make_pool() {
  SceneWriter writer({{"title", "A ball stirs a pool of 1 m x 1 m (6.2)"},
                      {"spacing_min_m", 0.012},
                      {"spacing_max_m", 0.05},
                      {"duration_s", kPoolDuration},
                      {"still_s", 2.5},
                      {"settle_s", kSettle},
                      {"domain_min_m", list({-0.85, -0.15, -0.85})},
                      {"domain_max_m", list({0.85, 1.0, 0.85})}});
  Paint paint{.color = {1.0, 1.0, 1.0, 1.0}, .roughness = 0.25};
  paint.base_color_map.image = writer.add_image("tiles", tile_picture());
  const int tiles = writer.add_material("tiles", paint);
  TriangleMesh basin = with_normals(tank(kInner, kPoolWall));
  lay_flat(basin, kTiles);
  const int rubber = writer.add_material("yellow rubber", {{0.85, 0.55, 0.05, 1.0}, 0.0, 0.45});
  const int look = writer.add_material("water", {{0.10, 0.35, 0.55, 0.5}, 0.0, 0.1});
  writer.add_node("pool", writer.add_mesh("pool", basin, tiles), {},
                  {{"slosh", "body"}, {"motion", "fixed"}, {"viscosity_pa_s", 0.0}});
  const Solid fluid = box({-0.5 * kInner.x, kPoolWall, -0.5 * kInner.z},
                          {0.5 * kInner.x, kPoolWall + kPoolFluidDepth, 0.5 * kInner.z});
  writer.add_node("water", writer.add_mesh("water", fluid, look), {},
                  {{"slosh", "fluid"},
                   {"density_kg_m3", 1000.0},
                   {"viscosity_pa_s", 0.05},
                   {"extinction_per_m", list({4.0, 1.2, 0.7})},
                   {"scattering", 0.3}});
  const int node =
      writer.add_node("ball", writer.add_mesh("ball", sphere(kBallRadius, 24, 48), rubber), ball_pose(0.0),
                      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 2.5}, {"viscosity_pa_s", 0.0}});
  writer.add_node("ball_hand", -1, {},
                  {{"slosh", "grip"},
                   {"stiffness_n_m", 2000.0},
                   {"damping_n_s_m", 60.0},
                   {"rotational_stiffness_nm_rad", 20.0},
                   {"rotational_damping_nm_s_rad", 0.6},
                   {"device", 0}},
                  node);
  writer.add_hand("ball_motion", "ball_hand", ball_pose, kPoolDuration);
  writer.add_camera({0.62, 1.10, 1.62}, {0.0, 0.17, 0.0}, 34.0);
  return writer;
}

}  // namespace slosh::make
