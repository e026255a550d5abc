#include "tests/support/tank.h"

#include <cmath>

namespace slosh::testing {

namespace {

void add_plane(SurfaceSamples& samples, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v,
               double spacing) {
  const int nu = static_cast<int>(std::lround(glm::length(u) / spacing));
  const int nv = static_cast<int>(std::lround(glm::length(v) / spacing));
  const glm::vec3 normal(glm::normalize(glm::cross(u, v)));
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      samples.positions.emplace_back(corner + u * ((i + 0.5) / nu) + v * ((j + 0.5) / nv));
      samples.normals.push_back(normal);
    }
  }
}

}  // namespace

TriangleMesh box_mesh(const glm::dvec3& lower, const glm::dvec3& upper) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 pick(i & 1, (i >> 1) & 1, (i >> 2) & 1);
    mesh.positions.emplace_back(glm::mix(lower, upper, pick));
  }
  mesh.normals.assign(8, glm::vec3(0.0f, 1.0f, 0.0f));
  const glm::uvec4 quads[] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const glm::uvec4& q : quads) {
    mesh.triangles.emplace_back(q.x, q.y, q.z);
    mesh.triangles.emplace_back(q.x, q.z, q.w);
  }
  return mesh;
}

int add_fluid_block(Scene& scene, SampledScene& sampled, int fluid, const glm::dvec3& lower,
                    const glm::dvec3& upper) {
  const double s = sampled.spacing;
  const glm::ivec3 n(glm::round((upper - lower) / s));
  for (int y = 0; y < n.y; ++y) {
    for (int z = 0; z < n.z; ++z) {
      for (int x = 0; x < n.x; ++x) {
        sampled.fluid_positions.emplace_back(lower + s * (glm::dvec3(x, y, z) + 0.5));
        sampled.fluid_velocities.emplace_back(0.0f);
        sampled.fluid_index.push_back(static_cast<std::uint8_t>(fluid));
      }
    }
  }
  FluidVolume volume;
  volume.name = "block";
  volume.mesh = static_cast<int>(scene.meshes.size());
  volume.fluid = fluid;
  scene.meshes.push_back(box_mesh(lower, upper));
  scene.fluid_volumes.push_back(volume);
  return n.x * n.y * n.z;
}

Tank make_tank(const TankOptions& o) {
  Tank tank;
  Fluid fluid;
  fluid.name = "fluid";
  fluid.rest_density = o.rest_density;
  fluid.dynamic_viscosity = o.viscosity;
  tank.scene.name = "tank";
  tank.scene.fluids.push_back(fluid);
  tank.sampled.spacing = o.spacing;
  const glm::dvec3 half(0.5 * o.inner.x, 0.0, 0.5 * o.inner.z);
  add_fluid_block(tank.scene, tank.sampled, 0, -half, {half.x, o.fill, half.z});
  Body walls;
  walls.name = "walls";
  walls.mesh = static_cast<int>(tank.scene.meshes.size());
  walls.measured = true;
  walls.dynamic_viscosity = o.wall_viscosity;
  tank.scene.meshes.push_back(box_mesh(-half - 0.05, glm::dvec3(half.x, o.inner.y, half.z) + 0.05));
  tank.scene.bodies.push_back(walls);
  SurfaceSamples samples;
  const glm::dvec3 x(o.inner.x, 0, 0), y(0, o.inner.y, 0), z(0, 0, o.inner.z);
  // The boundary layers sit half a spacing behind these planes, so floor and end walls reach one spacing
  // further: the edges between them would be open otherwise.
  const glm::dvec3 more_x(o.spacing, 0, 0), more_z(0, 0, o.spacing);
  add_plane(samples, -half - more_x - more_z, z + 2.0 * more_z, x + 2.0 * more_x, o.spacing);
  add_plane(samples, -half - more_z, y, z + 2.0 * more_z, o.spacing);
  add_plane(samples, -half + x - more_z, z + 2.0 * more_z, y, o.spacing);
  add_plane(samples, -half, x, y, o.spacing);
  add_plane(samples, -half + z, y, x, o.spacing);
  samples.particle_volume = static_cast<float>(std::pow(o.spacing, 3));
  tank.sampled.surfaces.push_back(samples);
  tank.sampled.distance_fields.emplace_back();
  tank.scene.domain_min = -half - 0.2;
  tank.scene.domain_max = glm::dvec3(half.x, o.inner.y, half.z) + 0.2;
  return tank;
}

}  // namespace slosh::testing
