#include "tests/lab/picture/score/pool.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render/renderer.h"
#include "tests/lab/picture/score/particles.h"

namespace slosh::score {
namespace {

// The pool fills x and z within these, m; the picture sees its inside alone.
constexpr float kHalf = 0.42f;
constexpr float kDepth = 0.04f;  // of the deepest wave
constexpr float kLayers = 5.0f;  // of particles under the surface; what is below them is not seen
constexpr glm::vec3 kDrop{0.05f, 0.17f, 0.03f};
constexpr float kDropRadius = 0.055f;

float height(float x, float z) {
  return 0.022f * std::sin(14.0f * x + 3.0f * z) + 0.015f * std::cos(17.0f * z - 6.0f * x);
}

glm::vec3 slope_normal(float x, float z) {
  const float dx =
      0.022f * 14.0f * std::cos(14.0f * x + 3.0f * z) + 0.015f * 6.0f * std::sin(17.0f * z - 6.0f * x);
  const float dz =
      0.022f * 3.0f * std::cos(14.0f * x + 3.0f * z) - 0.015f * 17.0f * std::sin(17.0f * z - 6.0f * x);
  return glm::normalize(glm::vec3(-dx, 1.0f, -dz));
}

View pool_view(int width, int height) {
  View view;
  view.view = glm::lookAt(glm::vec3(0.0f, 0.45f, 0.55f), glm::vec3(0.0f, 0.0f, 0.0f), glm::vec3(0, 1, 0));
  view.projection =
      glm::perspective(glm::radians(32.0f), static_cast<float>(width) / static_cast<float>(height),
                       view.near_plane, view.far_plane);
  return view;
}

/// Distance along a ray to the drop, below 0 where it misses.
float to_drop(const glm::vec3& from, const glm::vec3& way) {
  const glm::vec3 off = from - kDrop;
  const float b = glm::dot(off, way);
  const float inside = b * b - glm::dot(off, off) + kDropRadius * kDropRadius;
  return inside < 0.0f ? -1.0f : -b - std::sqrt(inside);
}

/// The same to the pool's surface.
float to_surface(const glm::vec3& from, const glm::vec3& way) {
  constexpr float kStep = 0.002f;
  const auto above = [&](float t) {
    const glm::vec3 at = from + t * way;
    return at.y - height(at.x, at.z);
  };
  float t = std::max((0.05f - from.y) / way.y, 0.0f);
  if (way.y >= 0.0f) return -1.0f;
  for (; above(t) > 0.0f; t += kStep) {
    if (t > 5.0f) return -1.0f;
  }
  float low = t - kStep;
  for (int i = 0; i < 20; ++i) {
    const float middle = 0.5f * (low + t);
    (above(middle) > 0.0f ? low : t) = middle;
  }
  return t;
}

}  // namespace

Frame Pool::frame() const {
  Frame frame;
  frame.view = view;
  frame.particles = particles;
  frame.particle_fluid = fluids;
  frame.fluids.resize(1);
  frame.particle_radius = 0.6204f * spacing;  // of the ball with a particle's volume
  return frame;
}

Pool make_pool(float pixels, int width, int height_pixels, std::uint32_t seed) {
  Pool pool;
  pool.view = pool_view(width, height_pixels);
  const float distance = std::hypot(0.45f, 0.55f);
  const float metre = 0.5f * static_cast<float>(height_pixels) * pool.view.projection[1][1] / distance;
  pool.spacing = pixels / metre / 0.6204f;
  const float inside = 0.5f * pool.spacing;  // a particle's volume reaches half a spacing past its centre
  const glm::vec3 low(-kHalf, -kDepth - kLayers * pool.spacing, -kHalf);
  const glm::vec3 high(kHalf, 0.3f, kHalf);
  std::vector<glm::vec3>& points = pool.particles;
  points = jitter_lattice(low, high, pool.spacing, seed);
  std::erase_if(points, [&](const glm::vec3& p) {
    const bool drop = glm::distance(p, kDrop) < kDropRadius - inside;
    const float level = height(p.x, p.z);
    return !drop && (p.y > level - inside || p.y < level - kLayers * pool.spacing);
  });
  relax(points, pool.spacing, low, high, 12);
  pool.fluids.assign(points.size(), 0);
  return pool;
}

Exact nothing_seen(int width, int height) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return {{width, height, 1, std::vector<float>(pixels, kNoFluidDepth)},
          {width, height, 3, std::vector<float>(3 * pixels, 0.0f)}};
}

bool is_fluid(float depth) {
  return depth < 0.5f * kNoFluidDepth;
}

double degrees_between(const glm::vec3& a, const glm::vec3& b) {
  return glm::degrees(std::acos(std::clamp(double{glm::dot(a, b)}, -1.0, 1.0)));
}

Exact exact_pool(const Pool& pool, int width, int height_pixels) {
  Exact exact = nothing_seen(width, height_pixels);
  const glm::mat4 world_from_eye = glm::inverse(pool.view.view);
  const glm::mat4& p = pool.view.projection;
  const glm::vec3 from(world_from_eye[3]);
  for (int y = 0; y < height_pixels; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec2 ndc(2.0f * (static_cast<float>(x) + 0.5f) / static_cast<float>(width) - 1.0f,
                          1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / static_cast<float>(height_pixels));
      const glm::vec3 eye_way(ndc.x / p[0][0], ndc.y / p[1][1], -1.0f);
      const glm::vec3 way = glm::normalize(glm::mat3(world_from_eye) * eye_way);
      const float drop = to_drop(from, way);
      const float t = drop > 0.0f ? drop : to_surface(from, way);
      const glm::vec3 at = from + t * way;
      if (t <= 0.0f || std::max(std::abs(at.x), std::abs(at.z)) > kHalf) continue;
      const glm::vec3 normal =
          glm::mat3(pool.view.view) * (drop > 0.0f ? (at - kDrop) / kDropRadius : slope_normal(at.x, at.z));
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x;
      exact.depth.values[i] = t / glm::length(eye_way);
      for (int c = 0; c < 3; ++c) exact.normal.values[3 * i + static_cast<std::size_t>(c)] = normal[c];
    }
  }
  return exact;
}

}  // namespace slosh::score
