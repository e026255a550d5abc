// Shapes, particles and views that the renderer's tests and its benchmark draw.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/renderer.h"
#include "tests/lab/picture/score/particles.h"

namespace slosh::kit {

struct Shape {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::uvec3> triangles;
};

Shape make_box(const glm::vec3& low, const glm::vec3& high);
Shape make_sphere(float radius, int rings = 24, int segments = 48);
/// An open box: a floor and four walls of `wall` thickness outside `low`–`high`.
Shape make_tank(const glm::vec3& low, const glm::vec3& high, float wall);
void append(Shape& to, const Shape& from);

/// Looks from `eye` to `target`.
View make_view(const glm::vec3& eye, const glm::vec3& target, int width, int height, float fov_deg = 40.0f);

using score::jitter_lattice;
using score::make_fluid;
using score::relax;

/// A dam break's slumped column of about `particles` in a glass tank on a table, a red ball half in it: the
/// picture to judge looks by, and the benchmark's load.
struct DamBreak {
  std::vector<glm::vec3> particles;
  std::vector<std::uint8_t> fluids;
  Frame frame;

  DamBreak(MeshSink& meshes, int particles, int width, int height);
};

/// Still water with a level surface at y = 0 in a shallow stone basin, looked at flat across; a red post
/// stands behind it and a ball swims in it: what it mirrors is known.
struct StillBasin {
  static constexpr glm::vec3 kLow{-0.40f, -0.06f, -0.25f};  ///< of the water, m
  static constexpr glm::vec3 kHigh{0.40f, 0.0f, 0.35f};
  static constexpr glm::vec3 kPostLow{-0.20f, -0.06f, -0.33f};
  static constexpr glm::vec3 kPostHigh{-0.13f, 0.22f, -0.28f};

  std::vector<glm::vec3> particles;
  std::vector<std::uint8_t> fluids;
  Frame frame;

  /// spacing: m between particles.
  StillBasin(MeshSink& meshes, float spacing, int width, int height);
};

FluidLook water();
FluidLook batter();
/// As scenes/FIELDS.md has it: clear enough to be seen through, and scattering.
FluidLook cloudy_juice();

}  // namespace slosh::kit
