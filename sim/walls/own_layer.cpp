#include "sim/walls/own_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "sim/walls/convex_edges.h"
#include "sim/walls/joined_walls.h"
#include "sim/walls/point_buckets.h"
#include "sim/walls/wall_inset.h"

namespace slosh {

namespace {

// Where walls count in the density, the force on fluid is the gradient of an energy only if each wall
// particle acts once (V_p² P_p). One lattice layer then yields under the pressure of a fluid, which acts
// twice (P_p and P_i), so a wall particle stands for two, and sits so far behind the surface that the fluid's
// first layer rests half a spacing off the mesh. Share 1 leaks, 1.5 to 3 do not; tests/physics checks level
// and weight. It sits wall_inset() behind the surface.

float solid_depth(const DistanceFieldView& field, const glm::vec3& p) {
  return field.distance ? -sample_distance(field, p).distance : std::numeric_limits<float>::infinity();
}

// Moves a surface particle into the solid by `depth`, m, or to the middle of a wall that is thinner than that
// twice.
glm::vec3 inset(const glm::vec3& surface, const glm::vec3& normal, float depth,
                const DistanceFieldView& field) {
  for (int tries = 0; tries < 5; ++tries, depth *= 0.8f) {
    const glm::vec3 p = surface - normal * depth;
    if (solid_depth(field, p) > 0.8f * depth) return p;
  }
  return surface - normal * depth;
}

constexpr float kTwoSides = 3.0f;  // depths: in a thinner wall the field, which is coarse, is round
// Spacings. A thinner wall's layers are one, as strong as a thick one's and as near as they are: with less,
// fluid got into the edge between floor and wall of a glass of 1.03 spacings and stayed there
// (tests/notebook/2026-11-26-thin-walls.md).
constexpr float kThinnest = 1.15f;

// m, how thick the solid is behind a point of its surface; `most` where it is more than that. Behind a wall
// one is soon well outside; along an edge, just within the other face, one is nowhere.
float thickness(const glm::vec3& surface, const glm::vec3& normal, float most,
                const DistanceFieldView& field) {
  constexpr int kLooks = 30, kFirst = 4, kBeyond = 5;
  const float stride = most / kLooks;
  const auto depth_at = [&](int look) {
    return solid_depth(field, surface - static_cast<float>(look) * stride * normal);
  };
  float before = depth_at(kFirst - 1);
  for (int look = kFirst; look <= kLooks; ++look) {
    const float depth = depth_at(look);
    if (depth >= 0.0f) {
      before = depth;
      continue;
    }
    const bool through = before > 0.0f && depth_at(look + kBeyond) < -0.5f * kBeyond * stride;
    return through ? stride * (static_cast<float>(look) - depth / (depth - before)) : most;
  }
  return most;
}

// Moves a surface particle straight into a wall whose two sides are near, and from its edges sideways: where
// the two meet the field, which is coarse, is round.
glm::vec3 in_thin_wall(const glm::vec3& surface, const glm::vec3& normal, float depth,
                       const DistanceFieldView& field) {
  constexpr float kSideways = 0.7f;
  const glm::vec3 p = surface - depth * normal;
  const DistanceSample s = sample_distance(field, p);
  const glm::vec3 along = s.gradient - glm::dot(s.gradient, normal) * normal;
  const float slope = glm::length(along);
  return slope > kSideways ? p - along / slope * std::max(depth + s.distance, 0.0f) : p;
}

// A place in the solid.
struct Place {
  glm::vec3 at;
  float lacks;  // m, of the depth that was asked for
};

// Moves a surface particle to the level set at `depth` inside the solid: along a convex edge, where going
// back along one face's normal comes out beside the other, that is the edge of a smaller body. Buoyancy of a
// box of 5 and 8 spacings with the edges left proud: +49 and +21 %, so -4 and +1 %. A wall that has none is
// entered to its middle.
// `thick`: m, of the solid there; `thin_near`: close by the wall has no such level set.
Place on_level_set(const glm::vec3& surface, const glm::vec3& normal, float depth, float thick,
                   bool thin_near, const DistanceFieldView& field) {
  constexpr float kThere = 0.8f;    // of the depth
  constexpr float kAstray = 1.5f;   // depths from the surface
  constexpr float kOnRidge = 0.9f;  // of the depth in a wall's middle that the field shows
  if (thick < kTwoSides * depth) {
    const float straight = std::min(depth, 0.5f * thick);
    return {in_thin_wall(surface, normal, straight, field), depth - straight};
  }
  glm::vec3 p = surface - normal * depth, deepest = p;
  float most = -std::numeric_limits<float>::infinity();
  for (int newton = 0; newton < 6; ++newton) {
    const DistanceSample s = sample_distance(field, p);
    const float slope = glm::dot(s.gradient, s.gradient);
    const float missing = depth + s.distance;
    if (missing < 0.02f * depth) return {p, 0.0f};
    if (-s.distance > most && glm::distance(p, surface) < kAstray * depth) {
      most = -s.distance;
      deepest = p;
    }
    if (slope < 0.1f) break;
    p -= s.gradient * (missing / slope);
  }
  if (solid_depth(field, p) > kThere * depth) return {p, 0.0f};
  p = inset(surface, normal, depth, field);
  if (!thin_near || solid_depth(field, p) >= most) return {p, 0.0f};
  // The edge of a plate.
  return {deepest, std::max(kOnRidge * depth - most, 0.0f)};
}

// Behind a bent surface a layer is smaller than the surface that it stands for: a ball of 1.5, 2.5 and 3.6
// spacings was pushed up by 10, 3.7 and 1 % less than the water it displaces, as one smaller by 0.07 spacings
// over its radius in spacings. So the layer of a convex surface lies less deep by that (0.075, by those
// balls). Vessels are bent the other way by a tenth and less, which is not seen.
constexpr float kLessDeep = 0.075f;
constexpr float kMinBent = 0.02f;   // a ball of 50 spacings; flat walls are none, bitwise
constexpr float kMaxBent = 0.7f;    // a ball of 1.4 spacings
constexpr float kSolidFrom = 0.9f;  // of a spacing

// The surface's mean curvature times the spacing at p, by the distance half a spacing off: from -kMaxBent
// (concave) to kMaxBent. 0 where there is no spacing of solid behind, at edges and on thin walls: with
// theirs less deep a box of 5 spacings was lifted by 3.1 % too much for 0.9, and a bucket's water swung
// otherwise.
float bend(const DistanceFieldView& field, const glm::vec3& p, const glm::vec3& normal, float spacing) {
  if (solid_depth(field, p - spacing * normal) < kSolidFrom * spacing) return 0.0f;
  const float off = 0.5f * spacing;
  float sum = -6.0f * sample_distance(field, p).distance;
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 step(0.0f);
    step[axis] = off;
    sum += sample_distance(field, p + step).distance + sample_distance(field, p - step).distance;
  }
  const float bent = 0.5f * sum / (off * off) * spacing;
  return std::abs(bent) < kMinBent ? 0.0f : std::clamp(bent, -kMaxBent, kMaxBent);
}

// In a concave edge the layers of the two faces part as they move back. Adds particles where the level set at
// that depth has none within kLargestHole of the way between its particles, walking the nodes of the distance
// field.
void close_gaps(const DistanceFieldView& field, float depth, float spacing, float apart,
                std::vector<LayerParticle>& layer) {
  PointBuckets near(spacing);
  for (const LayerParticle& p : layer) near.add(p.position);
  for_each_node(field, [&](float d, glm::vec3 p, int) {
    if (std::abs(d + depth) > field.cell) return;
    for (int newton = 0; newton < 2; ++newton) {
      const DistanceSample s = sample_distance(field, p);
      const float slope = glm::dot(s.gradient, s.gradient);
      if (slope > 0.25f) p -= s.gradient * ((s.distance + depth) / slope);
    }
    if (std::abs(sample_distance(field, p).distance + depth) > 0.1f * spacing) return;
    if (near.any_within(p, kLargestHole * apart)) return;
    layer.push_back({.position = p});
    near.add(p);
  });
}

constexpr float kNearEdges = 0.6f;  // of the depth behind faces that meet: as much a field has at least of it
// Spacings that the faces of a convex edge lie deeper near it. Without, boxes of 8 and 10 spacings are lifted
// by 1.1 and 0.9 % too much; a half of that is fluid that lies half a percent too closely
// (tests/notebook/2026-11-27-convex-edges.md).
constexpr float kDeeperNearEdges = 0.012f;

}  // namespace

float bend(const DistanceFieldView& field, const glm::vec3& p, float spacing) {
  if (!field.distance) return 0.0f;
  const glm::vec3 out = sample_distance(field, p).gradient;
  const float slope = glm::length(out);
  return slope > 0.5f ? bend(field, p, out / slope, spacing) : 0.0f;
}

float Depths::at(float bent) const {
  if (bent == 0.0f) return flat;
  return bent < 0.0f ? concave : convex - kLessDeep * bent;
}

// Of samples that are `apart` m from each other. In thick fluid concave layers keep the depth that
// wall_drag() was fitted with: less deep, drag on a turning cylinder is 6 % too large, not 3. So do all with
// implicit viscosity and pressure projection: less deep, momentum errors are four times as large.
Depths depths_of(const Scene& scene, const Plan& plan, float apart, DragLayer layer) {
  constexpr double kWhole = 0.99;  // of a spacing
  const double behind = wall_inset(scene.support_ratio);
  const bool both_solved = plan.implicit_viscosity && plan.model == ParticleModel::kIncompressible;
  const bool hollow = apart > kWhole * plan.spacing && !both_solved;
  const double flat = hollow ? behind - kOverHollows : behind;
  const double concave = layer == DragLayer::kBehind ? flat : behind;
  return {static_cast<float>(flat), static_cast<float>(concave), static_cast<float>(behind)};
}

std::vector<LayerParticle> own_layer(const SurfaceSamples& surface, const DistanceFieldView& field,
                                     const Plan& plan, const Depths& deep) {
  std::vector<LayerParticle> layer;
  layer.reserve(surface.positions.size());
  const float spacing = static_cast<float>(plan.spacing);
  const bool level = corrects_gradients(plan.model) && field.distance;
  std::vector<float> depths, thick;
  std::vector<bool> flat;
  PointBuckets thin(2.0f * spacing);
  std::optional<ConvexEdges> edges;
  if (level) edges.emplace(surface, spacing);
  for (std::size_t i = 0; level && i < surface.positions.size(); ++i) {
    const float bent = bend(field, surface.positions[i], surface.normals[i], spacing);
    const float depth = deep.at(bent) * spacing;
    depths.push_back(depth);
    flat.push_back(bent == 0.0f);
    thick.push_back(thickness(surface.positions[i], surface.normals[i], kTwoSides * depth, field));
    if (thick.back() < kTwoSides * depth && thick.back() >= kThinnest * spacing)
      thin.add(surface.positions[i]);
  }
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const glm::vec3& at = surface.positions[i];
    const glm::vec3& normal = surface.normals[i];
    if (plan.model == ParticleModel::kPaper) {
      layer.push_back({at, at, normal, 0.0f});
      continue;
    }
    const float depth = level ? depths[i] : deep.flat * spacing;
    if (!level) {
      layer.push_back({inset(at, normal, depth, field), at, normal, depth});
      continue;
    }
    const bool two_sided = thick[i] >= kThinnest * spacing;
    const bool thin_near = two_sided && thin.any_within(at, 2.0f * spacing);
    if (flat[i] && !thin_near && thick[i] >= kTwoSides * depth) {
      const float deeper = depth + kDeeperNearEdges * spacing;
      const std::optional<glm::vec3> p = edges->behind(i, deeper);
      if (p && solid_depth(field, *p) > kNearEdges * depth) {
        layer.push_back({*p, at, normal, deeper});
        continue;
      }
    }
    const Place place =
        on_level_set(at, normal, depth, two_sided ? thick[i] : kTwoSides * depth, thin_near, field);
    layer.push_back({place.at, at, two_sided ? normal : glm::vec3(0.0f), depth, place.lacks});
  }
  if (level) close_gaps(field, deep.flat * spacing, spacing, surface.apart, layer);
  return layer;
}

}  // namespace slosh
