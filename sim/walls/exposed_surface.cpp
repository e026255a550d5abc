#include "sim/walls/exposed_surface.h"

#include <algorithm>
#include <limits>

namespace slosh {
namespace {

// Of a cell: by how much less than the solid its field reaches at an edge, where it is round; of a spacing,
// at most that, since a face's samples begin half a spacing off a wall that stands on it. Where three bodies
// meet the ends of hidden faces were taken for open ones without: layers bent round them, and a tank of slabs
// lost 0.1 to 0.3 % of its water through its lower corners (4.6 to 3 mm).
constexpr float kRounded = 0.25f, kMaxRounded = 0.2f;
constexpr float kDisc = 0.5f;  // of the way to its neighbours: the radius of the surface around one sample

bool covers(const FixedSolid& solid, const glm::vec3& p, float spacing) {
  const float near = std::min(kRounded * solid.field.cell, kMaxRounded * spacing);
  return sample_distance(solid.field, to_world(inverse(solid.pose), p)).distance < near;
}

void note(std::vector<std::size_t>& numbers, std::size_t number) {
  if (std::ranges::find(numbers, number) == numbers.end()) numbers.push_back(number);
}

std::vector<SolidSample> samples_of(std::span<const FixedSolid> solids, std::size_t own, float spacing,
                                    std::vector<std::vector<std::size_t>>& touched) {
  std::vector<SolidSample> samples;
  const SurfaceSamples& surface = *solids[own].surface;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const glm::vec3 p = to_world(solids[own].pose, surface.positions[i]);
    const glm::vec3 normal(solids[own].pose.orientation * glm::dvec3(surface.normals[i]));
    bool hidden = false;
    for (std::size_t b = 0; b < solids.size(); ++b) {
      if (b == own || !covers(solids[b], p + kTouching * spacing * normal, spacing)) continue;
      hidden = true;
      note(touched[own], b);
      note(touched[b], own);
    }
    samples.push_back({p, normal, hidden});
  }
  return samples;
}

}  // namespace

void ExposedSurface::add(std::size_t solid, const glm::vec3& p, const glm::vec3& normal, float apart) {
  near_.add(p);
  radii_.push_back(kDisc * apart);
  normals_.push_back(normal);
  solids_.push_back(solid);
}

ExposedSurface::Bearing ExposedSurface::bearing_of(const glm::vec3& p, const glm::vec3& sample,
                                                   std::uint32_t number) const {
  const glm::vec3& normal = normals_[number];
  const float radius = radii_[number];
  const float above = glm::dot(p - sample, normal);
  const glm::vec3 beside = p - sample - above * normal;
  const float off = glm::length(beside);
  return {-above, off > radius, p - sample - (off > radius ? beside * (radius / off) : beside)};
}

ExposedSurface::Depth ExposedSurface::depth_at(const glm::vec3& p) const {
  Depth best{std::numeric_limits<float>::infinity(), {0.0f, 0.0f, 0.0f}};
  float least = best.depth;
  near_.around(p, [&](const glm::vec3& q, std::uint32_t n) {
    const Bearing bearing = bearing_of(p, q, n);
    const float distance = glm::length(bearing.away);
    if (distance >= least) return;
    least = distance;
    const bool outside = bearing.behind < 0.0f && !bearing.beside;
    best.depth = outside ? -distance : distance;
    best.inward = outside || distance < 1e-6f * radii_[n] ? -normals_[n] : bearing.away / distance;
  });
  return best;
}

std::size_t ExposedSurface::solid_at(const glm::vec3& p) const {
  constexpr float kUncovered = 0.5f, kStraight = 0.98f;
  struct Face {
    std::size_t solid;
    float distance, behind, apart;
  };
  std::vector<Face> faces;  // the nearest disc of each solid
  near_.around(p, [&](const glm::vec3& q, std::uint32_t n) {
    const Bearing bearing = bearing_of(p, q, n);
    const Face face{solids_[n], glm::length(bearing.away), bearing.behind, radii_[n] / kDisc};
    const auto known = std::ranges::find(faces, face.solid, &Face::solid);
    if (known == faces.end())
      faces.push_back(face);
    else if (face.distance < known->distance)
      *known = face;
  });
  const Face nearest = *std::ranges::min_element(faces, {}, &Face::distance);
  if (nearest.behind > kStraight * nearest.distance) return nearest.solid;
  std::erase_if(faces,
                [&](const Face& face) { return face.distance > nearest.distance + kUncovered * face.apart; });
  return std::ranges::max_element(faces, {}, &Face::behind)->solid;
}

TouchingSolids touching(std::span<const FixedSolid> solids, float spacing) {
  TouchingSolids found{{}, std::vector<std::vector<std::size_t>>(solids.size()), ExposedSurface(spacing)};
  for (std::size_t b = 0; b < solids.size(); ++b) {
    found.samples.push_back(samples_of(solids, b, spacing, found.touched));
    for (const SolidSample& s : found.samples[b])
      if (!s.hidden) found.surface.add(b, s.position, s.normal, solids[b].surface->apart);
  }
  return found;
}

bool covered(std::span<const FixedSolid> solids, std::span<const std::size_t> numbers, const glm::vec3& p,
             float spacing) {
  return std::ranges::any_of(numbers, [&](std::size_t b) { return covers(solids[b], p, spacing); });
}

FixedSolids fixed_solids(const Scene& scene, const SampledScene& sampled) {
  FixedSolids found;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (body.motion != BodyMotion::kFixed || body.point_probe || sampled.distance_fields[b].distance.empty())
      continue;
    found.solids.push_back({&sampled.surfaces[b], sampled.distance_fields[b].view(), body.pose});
    found.body_of.push_back(b);
  }
  return found;
}

}  // namespace slosh
