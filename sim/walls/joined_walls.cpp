#include "sim/walls/joined_walls.h"

#include <cmath>

#include "sim/walls/exposed_surface.h"
#include "sim/walls/point_buckets.h"

namespace slosh {
namespace {

// Of the depth: a wall that has less than twice that is one layer (kThinnest in wall_particles.cpp).
constexpr float kThinnest = 0.75f;

// Moves p to where it is `depth` below the surface. False where the solid is too thin for that.
bool settle(const ExposedSurface& surface, float depth, glm::vec3& p) {
  for (int turn = 0; turn < 8; ++turn) {
    const ExposedSurface::Depth there = surface.depth_at(p);
    if (std::abs(there.depth - depth) < 0.02f * depth) return true;
    if (!std::isfinite(there.depth)) return false;
    p += there.inward * (depth - there.depth);
  }
  return std::abs(surface.depth_at(p).depth - depth) < 0.1f * depth;
}

// The particles of all joined bodies, one by one, none in another's place.
class Layers {
 public:
  Layers(std::size_t bodies, float spacing) : near_(spacing), of_body_(bodies) {}

  void add(std::size_t body, const LayerParticle& p) {
    near_.add(p.position);
    of_body_[body].push_back(p);
  }
  /// Adds p unless it would be crowded in a layer of which neighbours are `apart` m from each other.
  void fill(std::size_t body, const glm::vec3& p, float apart) {
    if (!near_.any_within(p, kLargestHole * apart)) add(body, {.position = p});
  }
  std::vector<std::vector<LayerParticle>>& of_body() { return of_body_; }

 private:
  PointBuckets near_;
  std::vector<std::vector<LayerParticle>> of_body_;
};

// Walks the nodes of a body's distance field that may lie at `depth`.
template <class F>
void near_level_set(const FixedSolid& solid, float depth, F&& visit) {
  for_each_node(solid.field, [&](float d, const glm::vec3& p, int) {
    // The surface of all is nowhere nearer than the body's own.
    if (d <= 0.0f && -d <= depth + solid.field.cell) visit(to_world(solid.pose, p));
  });
}

}  // namespace

std::vector<std::vector<LayerParticle>> joined_layers(std::span<const FixedSolid> solids, float spacing) {
  const auto [samples, touched, surface] = touching(solids, spacing);
  Layers layers(solids.size(), spacing);
  const auto distance = [&](std::size_t b, const glm::vec3& p) {
    return sample_distance(solids[b].field, to_world(inverse(solids[b].pose), p)).distance;
  };
  for (std::size_t b = 0; b < solids.size(); ++b) {
    if (touched[b].empty()) continue;
    const float depth = solids[b].depth;
    for (const SolidSample& s : samples[b]) {
      if (s.hidden) continue;
      glm::vec3 p = s.position - depth * s.normal;
      float less = depth;
      // A wall that is too thin has its particles in its middle.
      for (; !settle(surface, less, p) && less > 0.3f * depth; less *= 0.8f)
        p = s.position - 0.8f * less * s.normal;
      // Behind a thin wall one is well outside, along an edge nowhere.
      const bool thin = distance(b, p - 2.5f * depth * s.normal) > 0.5f * depth;
      if (thin && less < kThinnest * depth)
        layers.add(b, {.position = p});
      else
        layers.add(b, {p, s.position, s.normal, depth, thin ? depth - less : 0.0f});
    }
  }
  // What is left open: where faces of two bodies meet in a concave edge, and their layers part as they move
  // back. Each particle there is of the body whose face it is farther behind, whichever body's mesh it lies
  // in: what a floor is pressed by is not to depend on whether it ends at the walls or goes on below them.
  for (std::size_t b = 0; b < solids.size(); ++b) {
    if (touched[b].empty()) continue;
    const float depth = solids[b].depth;
    const auto fill = [&](glm::vec3 p) {
      if (!settle(surface, depth, p) || distance(b, p) >= 0.0f) return;
      const std::size_t body = surface.solid_at(p);
      layers.fill(body, p, solids[body].surface->apart);
    };
    for (const SolidSample& s : samples[b])
      if (s.hidden) fill(s.position);
    near_level_set(solids[b], depth, fill);
  }
  for (std::size_t b = 0; b < solids.size(); ++b)
    for (LayerParticle& p : layers.of_body()[b]) p = moved(inverse(solids[b].pose), p);
  return std::move(layers.of_body());
}

std::vector<std::vector<std::uint32_t>> exposed_samples(std::span<const FixedSolid> solids, float spacing) {
  const TouchingSolids touch = touching(solids, spacing);
  std::vector<std::vector<std::uint32_t>> exposed(solids.size());
  for (std::size_t b = 0; b < solids.size(); ++b) {
    for (std::size_t i = 0; i < touch.samples[b].size(); ++i)
      if (!touch.samples[b][i].hidden) exposed[b].push_back(static_cast<std::uint32_t>(i));
  }
  return exposed;
}

}  // namespace slosh
