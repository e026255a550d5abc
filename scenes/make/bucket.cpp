// Two hands hold one bucket and tilt it to the left, the right and the left again; each time some fluid
// spills.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/make/motion.h"
#include "scenes/make/shipped.h"

namespace slosh::make {
namespace {

constexpr double kBottomRadius = 0.080;  ///< inner, at the floor
constexpr double kRimRadius = 0.095;     ///< inner, at the rim
constexpr double kInnerDepth = 0.160;
constexpr double kBucketFluidDepth = 0.105;
constexpr double kBucketHeld = 0.30;  ///< of the bucket's underside over the table
// Below the middle of bucket and water: a hand that is lowered then gets the greater load, as with any vessel
// that is carried by its sides; handles at the rim would let it swing like a pendulum towards the upper hand.
constexpr double kHandleHeight = 0.055;
constexpr double kHandleEnd = 0.088;    ///< where the loop enters the wall: nowhere does it come out inside
constexpr double kHandleReach = 0.025;  ///< straight part
constexpr double kBucketHandleRadius = 0.030;  ///< of the loop's bend
constexpr double kHandleThickness = 0.015;
constexpr double kBucketDuration = 10.0;

double inner_radius(double above_floor) {
  return kBottomRadius + (kRimRadius - kBottomRadius) * above_floor / kInnerDepth;
}

Solid handle(double side) {
  std::vector<glm::dvec3> path;
  const double bend = kHandleEnd + kHandleReach;
  for (int i = 0; i < 3; ++i)
    path.emplace_back(kHandleEnd + kHandleReach * i / 3.0, kHandleHeight, -kBucketHandleRadius);
  for (int i = 0; i <= 16; ++i) {
    const double angle = glm::pi<double>() * (i / 16.0 - 0.5);
    path.emplace_back(bend + kBucketHandleRadius * std::cos(angle), kHandleHeight,
                      kBucketHandleRadius * std::sin(angle));
  }
  for (int i = 2; i >= 0; --i)
    path.emplace_back(kHandleEnd + kHandleReach * i / 3.0, kHandleHeight, kBucketHandleRadius);
  for (glm::dvec3& p : path) p.x *= side;
  return tube(path, 0.5 * kHandleThickness, 24);
}

Solid bucket() {
  const double top = kWall + kInnerDepth;
  const std::vector<glm::dvec2> profile{{0.0, 0.0},
                                        {inner_radius(-kWall) + kWall, 0.0},
                                        {kRimRadius + kWall, top},
                                        {kRimRadius, top},
                                        {kBottomRadius, kWall},
                                        {0.0, kWall}};
  Solid out = lathe(round_corners(profile, 0.004, 3), 72);
  out = merged(std::move(out), handle(-1.0));
  return merged(std::move(out), handle(1.0));
}

Solid fluid() {
  return lathe({{0.0, kWall},
                {kBottomRadius, kWall},
                {inner_radius(kBucketFluidDepth), kWall + kBucketFluidDepth},
                {0.0, kWall + kBucketFluidDepth}},
               72);
}

/// Tilt about z, rad; positive lowers the −x side (the left).
double tilt(double time) {
  const auto deg = [](double d) { return glm::radians(d); };
  return follow(
      {{1.0, 0.0}, {2.4, deg(38)}, {3.9, 0.0}, {5.3, deg(-46)}, {6.8, 0.0}, {8.2, deg(56)}, {9.7, 0.0}},
      time);
}

Pose bucket_pose(double time) {
  const glm::dvec3 pivot(0.0, kBucketHeld + 0.5 * kInnerDepth, 0.0);
  const Pose rest{{0.0, kBucketHeld, 0.0}, {1.0, 0.0, 0.0, 0.0}};
  const glm::dquat turn = glm::angleAxis(tilt(time), glm::dvec3(0.0, 0.0, 1.0));
  return {pivot + turn * (rest.position - pivot), turn};
}

}  // namespace

SceneWriter make_bucket() {
  SceneWriter writer({{"title", "Two hands hold one bucket, tilt it and spill (6.4.4)"},
                      {"spacing_min_m", 0.006},
                      {"spacing_max_m", 0.012},
                      {"duration_s", kBucketDuration},
                      {"still_s", 5.2},
                      {"settle_s", kSettle},
                      {"domain_min_m", list({-0.65, -0.20, -0.45})},
                      {"domain_max_m", list({0.65, 0.85, 0.45})}});
  add_table(writer, 1.0, 0.6);
  const int red = writer.add_material("red enamel", {{0.55, 0.06, 0.05, 1.0}, 0.0, 0.22});
  const int look = writer.add_material("water", {{0.10, 0.35, 0.55, 0.5}, 0.0, 0.1});
  const Pose start = bucket_pose(0.0);
  const int node = writer.add_node(
      "bucket", writer.add_mesh("bucket", bucket(), red), start,
      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.8}, {"viscosity_pa_s", 0.0}, {"friction", 0.4}});
  writer.add_node("water", writer.add_mesh("water", fluid(), look), start,
                  {{"slosh", "fluid"},
                   {"density_kg_m3", 1000.0},
                   {"viscosity_pa_s", 0.05},
                   {"color", list({0.10, 0.42, 0.60})},
                   {"extinction_per_m", list({14.0, 4.0, 2.5})},
                   {"scattering", 0.35}});
  for (const bool right : {false, true}) {
    const std::string side = right ? "right" : "left";
    const glm::dvec3 at((right ? 1.0 : -1.0) * (kHandleEnd + kHandleReach + kBucketHandleRadius),
                        kHandleHeight, 0.0);
    const Pose grip{at, {1.0, 0.0, 0.0, 0.0}};
    writer.add_node(side + "_hand", -1, grip,
                    {{"slosh", "grip"},
                     {"stiffness_n_m", 2000.0},
                     {"damping_n_s_m", 60.0},
                     {"rotational_stiffness_nm_rad", 20.0},
                     {"rotational_damping_nm_s_rad", 0.6},
                     {"device", right ? 1 : 0}},
                    node);
    writer.add_hand(
        side + "_motion", side + "_hand", [=](double t) { return compose(bucket_pose(t), grip); },
        kBucketDuration);
  }
  writer.add_camera({0.30, 0.62, 1.02}, {0.03, 0.245, 0.0}, 33.0);
  return writer;
}

}  // namespace slosh::make
