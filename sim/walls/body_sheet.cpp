#include "sim/walls/body_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/walls/point_buckets.h"
#include "sim/walls/wall_inset.h"

namespace slosh {

namespace {

// Where walls count in the density, the force on fluid is the gradient of an energy only if each wall
// particle acts once (V_p² P_p). One lattice layer then yields under the pressure of a fluid, which acts
// twice (P_p and P_i), so a wall particle stands for two, and sits so far behind the surface that the fluid's
// first layer rests half a spacing off the mesh. Measured on a tank: share 1 leaks, 1.5 to 3 hold;
// tests/physics checks level and weight. It sits wall_inset() behind the surface.

// Moves a surface particle into the solid by `depth`, m, or to the middle of a wall that is thinner than that
// twice. `depth_at`: m, of a place in the solid.
template <class DepthAt>
glm::vec3 inset(const glm::vec3& surface, const glm::vec3& normal, float depth, DepthAt&& depth_at) {
  for (int tries = 0; tries < 5; ++tries, depth *= 0.8f) {
    const glm::vec3 p = surface - normal * depth;
    if (depth_at(p) > 0.8f * depth) return p;
  }
  return surface - normal * depth;
}

constexpr float kTwoSides = 3.0f;  // depths: a thinner wall is entered straight
// Spacings. A thinner wall's sheets are one, as strong as a thick one's and as near as they are: with less,
// fluid got into the edge between floor and wall of a glass of 1.03 spacings and stayed there
// (sim/walls/README.md).
constexpr float kThinnest = 1.15f;

// Moves a surface particle straight into a wall whose two sides are near, and from its edges sideways.
glm::vec3 in_thin_wall(const glm::vec3& surface, const glm::vec3& normal, float depth,
                       const SolidShape& solid) {
  constexpr float kSideways = 0.7f;
  const glm::vec3 p = surface - depth * normal;
  const DistanceSample s = solid.at(p);
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
                   bool thin_near, const SolidShape& solid) {
  constexpr float kThere = 0.8f;   // of the depth
  constexpr float kAstray = 1.5f;  // depths from the surface
  if (thick < kTwoSides * depth) {
    const float straight = std::min(depth, 0.5f * thick);
    return {in_thin_wall(surface, normal, straight, solid), depth - straight};
  }
  glm::vec3 p = surface - normal * depth, deepest = p;
  float most = -std::numeric_limits<float>::infinity();
  for (int newton = 0; newton < 6; ++newton) {
    const DistanceSample s = solid.at(p);
    const float missing = depth + s.distance;
    if (missing < 0.02f * depth) return {p, 0.0f};
    if (-s.distance > most && glm::distance(p, surface) < kAstray * depth) {
      most = -s.distance;
      deepest = p;
    }
    p -= s.gradient * missing;
  }
  if (thin_near) return {deepest, depth - most};  // the edge of a plate
  if (most > kThere * depth) return {deepest, 0.0f};
  return {inset(surface, normal, depth, [&](const glm::vec3& at) { return -solid.at(at).distance; }), 0.0f};
}

// Behind a bent surface a sheet is smaller than the surface that it stands for: a ball of 1.5, 2.5 and 3.6
// spacings was pushed up by 10, 3.7 and 1 % less than the water it displaces, as one smaller by 0.07 spacings
// over its radius in spacings. So the sheet of a convex surface lies less deep by that (0.075, by those
// balls). Vessels are bent the other way by a tenth and less, which is not seen.
constexpr float kLessDeep = 0.03f;
constexpr float kLeastBent = 0.02f;  // a ball of 50 spacings; flat walls are none, to the bit
constexpr float kMostBent = 0.7f;    // a ball of 1.4 spacings
constexpr float kSolidFrom = 0.9f;   // of a spacing

// In a concave edge the sheets of the two faces part as they move back. Adds particles where the level set at
// that depth has none within kLargestHole of the way between its particles, walking the nodes of the distance
// field. `at`: a place's DistanceSample.
template <class At>
void close_gaps(const DistanceFieldView& field, float depth, float spacing, float apart, At&& at,
                std::vector<SheetParticle>& sheet) {
  PointBuckets near(spacing);
  for (const SheetParticle& p : sheet) near.add(p.position);
  for_each_node(field, [&](float d, glm::vec3 p, int) {
    if (std::abs(d + depth) > field.cell) return;
    for (int newton = 0; newton < 2; ++newton) {
      const DistanceSample s = at(p);
      const float slope = glm::dot(s.gradient, s.gradient);
      if (slope > 0.25f) p -= s.gradient * ((s.distance + depth) / slope);
    }
    if (std::abs(at(p).distance + depth) > 0.1f * spacing) return;
    if (near.any_within(p, kLargestHole * apart)) return;
    sheet.push_back({.position = p});
    near.add(p);
  });
}

// By the mesh itself, of a model that corrects gradients.
std::vector<SheetParticle> level_sheet(const SurfaceSamples& surface, const DistanceFieldView& field,
                                       const SolidShape& solid, const Plan& plan, const SheetDepths& deep) {
  const float spacing = static_cast<float>(plan.spacing);
  std::vector<float> depths, thick;
  PointBuckets thin(2.0f * spacing);
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const glm::vec3 &at = surface.positions[i], &normal = surface.normals[i];
    depths.push_back(deep.at(bend(solid, at, normal, spacing)) * spacing);
    thick.push_back(solid.thickness(at, -normal));
    if (thick.back() < kTwoSides * depths.back() && thick.back() >= kThinnest * spacing) thin.add(at);
  }
  std::vector<SheetParticle> sheet;
  sheet.reserve(surface.positions.size());
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const glm::vec3 &at = surface.positions[i], &normal = surface.normals[i];
    const bool two_sided = thick[i] >= kThinnest * spacing;
    const Place place = on_level_set(at, normal, depths[i], two_sided ? thick[i] : kTwoSides * depths[i],
                                     two_sided && thin.any_within(at, 2.0f * spacing), solid);
    sheet.push_back({place.at, at, two_sided ? normal : glm::vec3(0.0f), depths[i], place.lacks});
  }
  const auto at = [&](const glm::vec3& p) { return solid.at(p); };
  close_gaps(field, deep.flat * spacing, spacing, surface.apart, at, sheet);
  return sheet;
}

// By the field, which is round at edges: of the models that are there to compare with.
std::vector<SheetParticle> inset_sheet(const SurfaceSamples& surface, const DistanceFieldView& field,
                                       const Plan& plan, float depth) {
  const auto depth_at = [&](const glm::vec3& p) {
    return field.distance ? -sample_distance(field, p).distance : std::numeric_limits<float>::infinity();
  };
  std::vector<SheetParticle> sheet;
  sheet.reserve(surface.positions.size());
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const glm::vec3 &at = surface.positions[i], &normal = surface.normals[i];
    sheet.push_back({inset(at, normal, depth, depth_at), at, normal, depth});
  }
  const auto at = [&](const glm::vec3& p) { return sample_distance(field, p); };
  if (field.distance) close_gaps(field, depth, static_cast<float>(plan.spacing), surface.apart, at, sheet);
  return sheet;
}

}  // namespace

// By the distance half a spacing off. With edges and thin walls less deep a box of 5 spacings was lifted by
// 3.1 % too much for 0.9, and a bucket's water swung otherwise.
float bend(const SolidShape& solid, const glm::vec3& sample, const glm::vec3& normal, float spacing) {
  if (-solid.at(sample - spacing * normal).distance < kSolidFrom * spacing) return 0.0f;
  const float off = 0.5f * spacing;
  float sum = -6.0f * solid.at(sample).distance;
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 step(0.0f);
    step[axis] = off;
    sum += solid.at(sample + step).distance + solid.at(sample - step).distance;
  }
  const float bent = 0.5f * sum / (off * off) * spacing;
  return std::abs(bent) < kLeastBent ? 0.0f : std::clamp(bent, -kMostBent, kMostBent);
}

float SheetDepths::at(float bent) const {
  if (bent == 0.0f) return flat;
  return bent < 0.0f ? concave : convex - kLessDeep * bent;
}

// In thick fluid concave walls are as deep as they were when what drags was chosen: less deep a cylinder of 1
// Pa·s that suddenly turns takes 6 % too much for 3. So are all where drag and pressures are solved for: a
// dam of 100 000 Pa·s had its momentum off by 3.6e-5 a step for 8e-6.
SheetDepths sheet_depths(const Scene& scene, const Plan& plan, float apart, DragSheet sheet) {
  constexpr double kWhole = 0.99;  // of a spacing
  const double behind = wall_inset(plan.model, scene.support_ratio);
  const bool both_solved = plan.solves_drag && plan.model == ParticleModel::kIncompressible;
  const bool hollow = corrects_gradients(plan.model) && apart > kWhole * plan.spacing && !both_solved;
  const double flat = hollow ? behind - kOverHollows : behind;
  const double concave = sheet == DragSheet::kBehind ? flat : behind;
  return {static_cast<float>(flat), static_cast<float>(concave), static_cast<float>(behind)};
}

std::vector<SheetParticle> body_sheet(const SurfaceSamples& surface, const DistanceFieldView& field,
                                      const SolidShape* solid, const Plan& plan, const SheetDepths& deep) {
  if (solid && corrects_gradients(plan.model)) return level_sheet(surface, field, *solid, plan, deep);
  if (plan.model != ParticleModel::kPaper)
    return inset_sheet(surface, field, plan, deep.flat * static_cast<float>(plan.spacing));
  std::vector<SheetParticle> sheet;
  for (std::size_t i = 0; i < surface.positions.size(); ++i)
    sheet.push_back({surface.positions[i], surface.positions[i], surface.normals[i], 0.0f});
  return sheet;
}

}  // namespace slosh
