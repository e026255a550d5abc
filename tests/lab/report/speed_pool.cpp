#include "tests/lab/report/speed_pool.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/trial.h"

namespace slosh::report {
namespace {

constexpr double kPoolDensity = 1000.0;  // kg/m³
constexpr double kPoolViscosity = 0.05;  // Pa·s
constexpr double kRoomAround = 10.0;     // spacings, that the pool is wider than the largest sphere

/// Where everything is.
struct Layout {
  double spacing = 0.0;  // m
  double width = 0.0;    // m
  double depth = 0.0;    // m, with what spheres displace
  double radius = 0.0;   // m, of a sphere
  double draught = 0.0;  // m
  std::vector<glm::dvec3> centers;

  /// m³ of fluid that a sphere displaces.
  double displaced() const { return kPi * draught * draught * (radius - draught / 3.0); }
};

Layout lay_out(std::size_t particles, std::size_t on_spheres, int spheres) {
  Layout out;
  const double side = std::round(std::cbrt(5.0 * static_cast<double>(particles)));
  const double s = out.spacing = 1.0 / side;
  double widest = 0.0;  // spacings, the radius of all of them as one
  if (spheres > 0) {
    widest = std::sqrt(static_cast<double>(on_spheres) / (4.0 * kPi));
    out.radius = s * widest / std::sqrt(spheres);
  }
  out.width = s * std::max(side, std::ceil(2.0 * widest + kRoomAround));
  const double area = out.width * out.width;
  out.depth = static_cast<double>(particles - on_spheres) * s * s * s / area;
  out.draught = std::min(out.radius, 0.6 * out.depth);
  out.depth += spheres * out.displaced() / area;
  const int rows = static_cast<int>(std::lround(std::sqrt(spheres)));
  for (int i = 0; i < rows * rows; ++i) {
    const auto place = [&](int k) { return out.width * ((k + 0.5) / rows - 0.5); };
    out.centers.emplace_back(place(i % rows), out.depth - out.draught + out.radius, place(i / rows));
  }
  return out;
}

/// A lattice from the floor up, half a spacing off walls and spheres.
void fill(const Layout& at, std::size_t count, SampledScene& sampled) {
  const double s = at.spacing;
  const int side = static_cast<int>(std::lround(at.width / s));
  const double clear = at.radius + 0.5 * s;
  for (int layer = 0; sampled.fluid_positions.size() < count; ++layer) {
    for (int i = 0; i < side * side && sampled.fluid_positions.size() < count; ++i) {
      const glm::dvec3 x((i % side + 0.5) * s - 0.5 * at.width, (layer + 0.5) * s,
                         (i / side + 0.5) * s - 0.5 * at.width);
      if (std::none_of(at.centers.begin(), at.centers.end(),
                       [&](const glm::dvec3& c) { return glm::distance(x, c) < clear; }))
        sampled.fluid_positions.emplace_back(x);
    }
  }
  sampled.fluid_velocities.assign(count, glm::vec3(0.0f));
  sampled.fluid_index.assign(count, 0);
}

}  // namespace

SpeedPool speed_pool(std::size_t particles, std::size_t on_spheres, int spheres) {
  const Layout at = lay_out(particles, on_spheres, spheres);
  SceneBuilder b;
  b.scene.name = "speed pool";
  b.add_fluid(kPoolDensity, kPoolViscosity);
  const double wall = 3.0 * at.spacing, half = 0.5 * at.width;
  const int tank =
      b.add_fixed("tank", tank_at_floor({at.width, 1.5 * at.depth + 4.0 * at.spacing, at.width}, wall));
  b.scene.bodies[0].measured = false;
  b.scene.bodies[0].material.opacity = 0.15f;
  for (const glm::dvec3& center : at.centers) {
    Pose pose;
    pose.position = center;
    if (b.scene.bodies.size() == 1) {
      b.add_free("sphere", make::sphere(at.radius, 24, 48), kPoolDensity * at.displaced(), pose);
      continue;
    }
    Body next = b.scene.bodies.back();  // of the same mesh, which is sampled once
    next.pose = pose;
    b.scene.bodies.push_back(next);
  }
  b.set_domain({-0.6 * at.width, -0.2 * at.width, -0.6 * at.width},
               {0.6 * at.width, 0.8 * at.width, 0.6 * at.width});
  b.scene.camera.target = {0.0, 0.5 * at.depth, 0.0};
  b.scene.camera.eye = {0.7 * at.width, 0.9 * at.width, 1.2 * at.width};
  // Without the volume of fluid: it reaches into the spheres, and the lattice is made to the particle.
  Result<SampledScene> sampled = sample_scene(b.scene, at.spacing);
  if (!sampled) throw Refused(sampled.error());
  b.add_volume(make::box({-half, 0.0, -half}, {half, at.depth, half}));
  SpeedPool pool{std::move(b.scene), std::move(sampled.value())};
  for (std::size_t body = 0; body < pool.sampled.surfaces.size(); ++body) {
    const std::size_t count = pool.sampled.surfaces[body].positions.size();
    (static_cast<int>(body) == tank ? pool.wall_particles : pool.body_particles) += count;
  }
  fill(at, particles - pool.body_particles, pool.sampled);
  return pool;
}

}  // namespace slosh::report
