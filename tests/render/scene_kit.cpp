#include "tests/render/scene_kit.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace slosh::kit {
void append(Shape& to, const Shape& from) {
  const auto base = static_cast<glm::uint>(to.positions.size());
  to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
  to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
  for (const glm::uvec3& t : from.triangles) to.triangles.push_back(t + base);
}

Shape make_box(const glm::vec3& low, const glm::vec3& high) {
  Shape shape;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      glm::vec3 normal(0.0f);
      normal[axis] = side ? 1.0f : -1.0f;
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      const auto base = static_cast<glm::uint>(shape.positions.size());
      for (int corner = 0; corner < 4; ++corner) {
        glm::vec3 at;
        at[axis] = side ? high[axis] : low[axis];
        at[u] = (corner & 1) ? high[u] : low[u];
        at[v] = (corner & 2) ? high[v] : low[v];
        shape.positions.push_back(at);
        shape.normals.push_back(normal);
      }
      if (side) {
        shape.triangles.push_back({base, base + 1, base + 3});
        shape.triangles.push_back({base, base + 3, base + 2});
      } else {
        shape.triangles.push_back({base, base + 3, base + 1});
        shape.triangles.push_back({base, base + 2, base + 3});
      }
    }
  }
  return shape;
}

Shape make_sphere(float radius, int rings, int segments) {
  Shape shape;
  for (int r = 0; r <= rings; ++r) {
    const float polar = glm::pi<float>() * static_cast<float>(r) / static_cast<float>(rings);
    for (int s = 0; s <= segments; ++s) {
      const float around = glm::two_pi<float>() * static_cast<float>(s) / static_cast<float>(segments);
      const glm::vec3 n(std::sin(polar) * std::cos(around), std::cos(polar),
                        std::sin(polar) * std::sin(around));
      shape.positions.push_back(n * radius);
      shape.normals.push_back(n);
    }
  }
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      const auto a = static_cast<glm::uint>(r * (segments + 1) + s);
      const auto b = a + static_cast<glm::uint>(segments) + 1;
      shape.triangles.push_back({a, a + 1, b});
      shape.triangles.push_back({a + 1, b + 1, b});
    }
  }
  return shape;
}

Shape make_tank(const glm::vec3& low, const glm::vec3& high, float wall) {
  const glm::vec3 out_low = low - wall;
  const glm::vec3 out_high(high.x + wall, high.y, high.z + wall);
  Shape tank = make_box(out_low, {out_high.x, low.y, out_high.z});
  append(tank, make_box({out_low.x, low.y, out_low.z}, {low.x, high.y, out_high.z}));
  append(tank, make_box({high.x, low.y, out_low.z}, out_high));
  append(tank, make_box({low.x, low.y, out_low.z}, {high.x, high.y, low.z}));
  append(tank, make_box({low.x, low.y, high.z}, {high.x, high.y, out_high.z}));
  return tank;
}

View make_view(const glm::vec3& eye, const glm::vec3& target, int width, int height, float fov_deg) {
  View view;
  view.view = glm::lookAt(eye, target, glm::vec3(0.0f, 1.0f, 0.0f));
  view.projection =
      glm::perspective(glm::radians(fov_deg), static_cast<float>(width) / static_cast<float>(height),
                       view.near_plane, view.far_plane);
  return view;
}

FluidLook water() {
  return {};
}

FluidLook batter() {
  FluidLook look;
  look.color = {0.93f, 0.78f, 0.42f};
  look.extinction = glm::vec3(400.0f, 500.0f, 700.0f);
  look.specular = glm::vec3(0.25f);
  look.specular_exponent = 60.0f;
  look.scattering = 1.0f;
  look.roughness = 0.4f;
  return look;
}

FluidLook cloudy_juice() {
  FluidLook look;
  look.color = {0.85f, 0.35f, 0.06f};
  look.extinction = {3.0f, 9.0f, 25.0f};
  look.scattering = 0.5f;
  look.refraction = 1.35f;
  return look;
}

DamBreak::DamBreak(MeshSink& meshes, int wanted, int width, int height) {
  const glm::vec3 low(-0.25f, 0.0f, -0.125f);
  const glm::vec3 high(0.25f, 0.28f, 0.125f);
  const auto surface = [](float x, float z) {
    return 0.055f + 0.15f / (1.0f + std::exp((x + 0.06f) * 26.0f)) +
           0.008f * std::sin(24.0f * x + 14.0f * z) + 0.006f * std::cos(31.0f * z - 11.0f * x);
  };
  // Volume under the surface, roughly, shared among the particles.
  const float spacing = std::cbrt(0.0113f / static_cast<float>(wanted));
  particles = make_fluid(low + 0.5f * spacing, high - 0.5f * spacing, spacing, surface);
  const glm::vec3 ball(0.10f, 0.058f, 0.02f);
  std::erase_if(particles,
                [&](const glm::vec3& p) { return glm::distance(p, ball) < 0.045f + 0.5f * spacing; });
  fluids.assign(particles.size(), 0);

  const auto add = [&](const Shape& shape, const MeshLook& look, const glm::vec3& at) {
    const MeshHandle mesh = meshes.add_mesh(shape.positions, shape.normals, shape.triangles);
    frame.meshes.push_back({mesh, glm::translate(glm::mat4(1.0f), at), look});
  };
  add(make_box({-0.9f, -0.05f, -0.6f}, {0.9f, -0.006f, 0.6f}), {{0.24f, 0.15f, 0.09f}, 0.0f, 0.55f, 1.0f},
      {});
  add(make_sphere(0.045f), {{0.75f, 0.10f, 0.06f}, 0.0f, 0.3f, 1.0f}, ball);
  add(make_sphere(0.03f), {{0.85f, 0.85f, 0.82f}, 1.0f, 0.25f, 1.0f}, {0.36f, 0.024f, 0.10f});
  add(make_tank(low, high, 0.004f), {{0.85f, 0.95f, 0.95f}, 0.0f, 0.05f, 0.02f}, {});

  frame.view = make_view({0.28f, 0.42f, 0.78f}, {0.0f, 0.07f, 0.0f}, width, height);
  frame.particles = particles;
  frame.particle_fluid = fluids;
  frame.fluids = {water()};
  frame.particle_radius = 0.62f * spacing;
}

StillBasin::StillBasin(MeshSink& meshes, float spacing, int width, int height) {
  particles = jitter_lattice(kLow + 0.5f * spacing, kHigh - 0.5f * spacing, spacing, 1);
  relax(particles, spacing, kLow + 0.5f * spacing, kHigh - 0.5f * spacing, 8);
  const glm::vec3 ball(0.14f, 0.03f, -0.06f);
  std::erase_if(particles,
                [&](const glm::vec3& p) { return glm::distance(p, ball) < 0.055f + 0.5f * spacing; });
  fluids.assign(particles.size(), 0);
  const auto add = [&](const Shape& shape, const MeshLook& look, const glm::vec3& at) {
    const MeshHandle mesh = meshes.add_mesh(shape.positions, shape.normals, shape.triangles);
    frame.meshes.push_back({mesh, glm::translate(glm::mat4(1.0f), at), look});
  };
  add(make_tank(kLow, {kHigh.x, 0.006f, kHigh.z}, 0.02f), {{0.30f, 0.29f, 0.27f}, 0.0f, 0.8f, 1.0f}, {});
  add(make_box(kPostLow, kPostHigh), {{0.80f, 0.06f, 0.04f}, 0.0f, 0.9f, 1.0f}, {});
  add(make_sphere(0.055f), {{0.85f, 0.60f, 0.10f}, 0.0f, 0.5f, 1.0f}, ball);
  frame.view = make_view({0.0f, 0.20f, 0.85f}, {0.0f, 0.02f, -0.1f}, width, height);
  frame.particles = particles;
  frame.particle_fluid = fluids;
  frame.fluids = {water()};
  frame.particle_radius = 0.62f * spacing;
}

}  // namespace slosh::kit
