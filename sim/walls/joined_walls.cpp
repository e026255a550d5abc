#include "sim/walls/joined_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/walls/point_buckets.h"

namespace slosh {
namespace {

// Of the depth: a wall that has less than twice that is one sheet (kThinnest in wall_particles.cpp).
constexpr float kThinnest = 0.75f;
constexpr float kTouching = 0.25f;  // of a spacing: no fluid gets into a gap of that
constexpr float kDisc = 0.5f;  // of the way to its neighbours: the radius of the surface around one sample

glm::vec3 to_world(const Pose& pose, const glm::vec3& p) {
  return glm::vec3(transform_point(pose, glm::dvec3(p)));
}

struct Depth {
  float depth;       // m below the surface, negative outside
  glm::vec3 inward;  // unit
};

// How a point lies to the surface around one sample.
struct Bearing {
  float behind;    // m, behind the plane through it; negative before it
  bool beside;     // is it beside the sample's disc
  glm::vec3 away;  // m, from the nearest point of the disc
};

// The surface that is left of all bodies together, as discs around their samples. World frame.
class ExposedSurface {
 public:
  explicit ExposedSurface(float spacing) : near_(2.0f * spacing) {}

  /// `apart`: m, from the sample to its neighbours.
  void add(std::size_t body, const glm::vec3& p, const glm::vec3& normal, float apart) {
    near_.add(p);
    radii_.push_back(kDisc * apart);
    normals_.push_back(normal);
    bodies_.push_back(body);
  }

  /// Of a point within two spacings of the surface; farther inside, infinity.
  Depth depth_at(const glm::vec3& p) const {
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

  /// Whose a point within two spacings of the surface is: of the body straight behind whose face it is, and
  /// beyond the edge where two faces meet of the one that it is farther behind. There both are as near, but
  /// for what discs leave uncovered of a face at its edge (0.2 of the way between samples).
  std::size_t body_at(const glm::vec3& p) const {
    constexpr float kUncovered = 0.5f, kStraight = 0.98f;
    struct Face {
      std::size_t body;
      float distance, behind, apart;
    };
    std::vector<Face> faces;  // the nearest disc of each body
    near_.around(p, [&](const glm::vec3& q, std::uint32_t n) {
      const Bearing bearing = bearing_of(p, q, n);
      const Face face{bodies_[n], glm::length(bearing.away), bearing.behind, radii_[n] / kDisc};
      const auto known = std::ranges::find(faces, face.body, &Face::body);
      if (known == faces.end())
        faces.push_back(face);
      else if (face.distance < known->distance)
        *known = face;
    });
    const Face nearest = *std::ranges::min_element(faces, {}, &Face::distance);
    if (nearest.behind > kStraight * nearest.distance) return nearest.body;
    std::erase_if(
        faces, [&](const Face& face) { return face.distance > nearest.distance + kUncovered * face.apart; });
    return std::ranges::max_element(faces, {}, &Face::behind)->body;
  }

 private:
  // Of p to the n-th sample, which is at q.
  Bearing bearing_of(const glm::vec3& p, const glm::vec3& q, std::uint32_t n) const {
    const glm::vec3& normal = normals_[n];
    const float radius = radii_[n];
    const float above = glm::dot(p - q, normal);
    const glm::vec3 beside = p - q - above * normal;
    const float off = glm::length(beside);
    return {-above, off > radius, p - q - (off > radius ? beside * (radius / off) : beside)};
  }

  PointBuckets near_;
  std::vector<float> radii_;
  std::vector<glm::vec3> normals_;
  std::vector<std::size_t> bodies_;
};

// Whether p, in front of a face of `own`, is inside another body; both are then joined.
bool covered(std::span<const FixedSolid> solids, std::size_t own, const glm::vec3& p,
             std::vector<bool>& joined) {
  bool found = false;
  for (std::size_t b = 0; b < solids.size(); ++b) {
    if (b == own || sample_distance(solids[b].field, to_world(inverse(solids[b].pose), p)).distance >= 0.0f)
      continue;
    found = joined[b] = joined[own] = true;
  }
  return found;
}

// Moves p to where it is `depth` below the surface. False where the solid is too thin for that.
bool settle(const ExposedSurface& surface, float depth, glm::vec3& p) {
  for (int turn = 0; turn < 8; ++turn) {
    const Depth there = surface.depth_at(p);
    if (std::abs(there.depth - depth) < 0.02f * depth) return true;
    if (!std::isfinite(there.depth)) return false;
    p += there.inward * (depth - there.depth);
  }
  return std::abs(surface.depth_at(p).depth - depth) < 0.1f * depth;
}

struct Sample {
  glm::vec3 position, normal;  // world frame
  bool hidden;
};

std::vector<Sample> samples_of(std::span<const FixedSolid> solids, std::size_t b, float spacing,
                               std::vector<bool>& joined) {
  std::vector<Sample> samples;
  const SurfaceSamples& surface = *solids[b].surface;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const glm::vec3 p = to_world(solids[b].pose, surface.positions[i]);
    const glm::vec3 normal(solids[b].pose.orientation * glm::dvec3(surface.normals[i]));
    samples.push_back({p, normal, covered(solids, b, p + kTouching * spacing * normal, joined)});
  }
  return samples;
}

// The particles of all joined bodies, one by one, none in another's place.
class Sheets {
 public:
  Sheets(std::size_t bodies, float spacing) : near_(spacing), of_body_(bodies) {}

  void add(std::size_t body, const SheetParticle& p) {
    near_.add(p.position);
    of_body_[body].push_back(p);
  }
  /// Adds p unless it would be crowded in a sheet of which neighbours are `apart` m from each other.
  void fill(std::size_t body, const glm::vec3& p, float apart) {
    if (!near_.any_within(p, kLargestHole * apart)) add(body, {.position = p});
  }
  std::vector<std::vector<SheetParticle>>& of_body() { return of_body_; }

 private:
  PointBuckets near_;
  std::vector<std::vector<SheetParticle>> of_body_;
};

// Walks the nodes of a body's distance field that may lie at `depth`.
template <class F>
void near_level_set(const FixedSolid& solid, float depth, F&& visit) {
  const DistanceFieldView& field = solid.field;
  for (int z = 0; z < field.size.z; ++z) {
    for (int y = 0; y < field.size.y; ++y) {
      for (int x = 0; x < field.size.x; ++x) {
        const float d = field.distance[x + field.size.x * (y + field.size.y * z)];
        // The surface of all is nowhere nearer than the body's own.
        if (d > 0.0f || -d > depth + field.cell) continue;
        visit(to_world(solid.pose, field.origin + field.cell * glm::vec3(x, y, z)));
      }
    }
  }
}

}  // namespace

std::vector<std::vector<SheetParticle>> joined_sheets(std::span<const FixedSolid> solids, float spacing) {
  std::vector<std::vector<Sample>> samples;
  std::vector<bool> joined(solids.size(), false);
  ExposedSurface surface(spacing);
  for (std::size_t b = 0; b < solids.size(); ++b) {
    samples.push_back(samples_of(solids, b, spacing, joined));
    for (const Sample& s : samples[b])
      if (!s.hidden) surface.add(b, s.position, s.normal, solids[b].surface->apart);
  }

  Sheets sheets(solids.size(), spacing);
  const auto distance = [&](std::size_t b, const glm::vec3& p) {
    return sample_distance(solids[b].field, to_world(inverse(solids[b].pose), p)).distance;
  };
  for (std::size_t b = 0; b < solids.size(); ++b) {
    if (!joined[b]) continue;
    const float depth = solids[b].depth;
    for (const Sample& s : samples[b]) {
      if (s.hidden) continue;
      glm::vec3 p = s.position - depth * s.normal;
      float less = depth;
      // A wall that is too thin has its particles in its middle.
      for (; !settle(surface, less, p) && less > 0.3f * depth; less *= 0.8f)
        p = s.position - 0.8f * less * s.normal;
      // Behind a thin wall one is well outside, along an edge nowhere.
      const bool thin = distance(b, p - 2.5f * depth * s.normal) > 0.5f * depth;
      if (thin && less < kThinnest * depth)
        sheets.add(b, {.position = p});
      else
        sheets.add(b, {p, s.position, s.normal, depth, thin ? depth - less : 0.0f});
    }
  }
  // What is left open: where faces of two bodies meet in a concave edge, and their sheets part as they move
  // back. Each particle there is of the body whose face it is farther behind, whichever body's mesh it lies
  // in: what a floor is pressed by is not to depend on whether it ends at the walls or goes on below them.
  for (std::size_t b = 0; b < solids.size(); ++b) {
    if (!joined[b]) continue;
    const float depth = solids[b].depth;
    const auto fill = [&](glm::vec3 p) {
      if (!settle(surface, depth, p) || distance(b, p) >= 0.0f) return;
      const std::size_t body = surface.body_at(p);
      sheets.fill(body, p, solids[body].surface->apart);
    };
    for (const Sample& s : samples[b])
      if (s.hidden) fill(s.position);
    near_level_set(solids[b], depth, fill);
  }
  for (std::size_t b = 0; b < solids.size(); ++b)
    for (SheetParticle& p : sheets.of_body()[b]) p = moved(inverse(solids[b].pose), p);
  return std::move(sheets.of_body());
}

std::vector<std::vector<std::uint32_t>> exposed_samples(std::span<const FixedSolid> solids, float spacing) {
  std::vector<std::vector<std::uint32_t>> exposed(solids.size());
  std::vector<bool> joined(solids.size(), false);
  for (std::size_t b = 0; b < solids.size(); ++b) {
    const std::vector<Sample> samples = samples_of(solids, b, spacing, joined);
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (!samples[i].hidden) exposed[b].push_back(static_cast<std::uint32_t>(i));
  }
  return exposed;
}

}  // namespace slosh
