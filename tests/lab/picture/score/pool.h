// An analytic pool: a wavy surface with a drop over it, as particles and as exact depths and normals.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/frame.h"
#include "render/image.h"

namespace slosh::score {

struct Pool {
  std::vector<glm::vec3> particles;  ///< m
  std::vector<std::uint8_t> fluids;
  float spacing = 0.0f;  ///< m
  View view;
  /// Points into `particles`: the pool must outlive it and stay where it is.
  Frame frame() const;
};

/// A pool whose particles have a radius of `pixels` (>= 2) in a picture of that size, at the pool's middle.
/// Particles are jittered off a lattice and pushed apart; `seed` picks which.
Pool make_pool(float pixels, int width, int height, std::uint32_t seed = 1);

/// What a picture of it should be. Top row first, as read_buffer.
struct Exact {
  FloatImage depth;   ///< m, linear eye depth; kNoFluidDepth = none
  FloatImage normal;  ///< three channels, eye axes
};
/// Of a picture without fluid.
Exact nothing_seen(int width, int height);
/// Whether a pixel of such a depth shows fluid.
bool is_fluid(float depth);
/// Of the angle between two unit vectors.
double degrees_between(const glm::vec3& a, const glm::vec3& b);

Exact exact_pool(const Pool& pool, int width, int height);

}  // namespace slosh::score
