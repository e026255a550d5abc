// Penetration clamp: continuous collision detection of a particle's way, in the frame of a body that moves
// itself.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "sim/math/distance_field.h"
#include "sim/math/host_device.h"
#include "sim/walls/surface_motion.h"

namespace slosh {

/// A ball in which a body's solid lies all through a sub-step. Most bodies are ruled out by these 16 bytes.
struct BoundingSphere {
  glm::vec3 center{1e18f};  ///< m, world; unless set out of everyone's reach
  float radius = 0.0f;      ///< m

  /// Whether who came to x, over `way` m in the world, can have met the solid.
  SLOSH_HD bool meets(const glm::vec3& x, float way) const {
    const glm::vec3 off = x - center;
    return glm::dot(off, off) <= (radius + way) * (radius + way);
  }
};

/// A body's solid and its way through one sub-step.
struct ClampBody {
  DistanceFieldView field;      ///< in the memory of whoever reads it
  SurfaceMotion before, after;  ///< as the sub-step begins and ends; of `before` only the place counts
  float depth = 0.0f;           ///< m, how far into the solid a particle may get, > 0
  /// Moves so far in the sub-step that it can meet particles that had none of its own near when that began.
  bool fast = false;
};

namespace penetration_clamp {

inline constexpr float kRest = 0.95f;      ///< of the depth: where a particle is put back to
inline constexpr float kStride = 0.7f;     ///< of the depth, between two looks along the way
inline constexpr int kMaxLooks = 64;       ///< along one way
inline constexpr int kMaxIterations = 4;   ///< clamps by walls of one body in one sub-step
inline constexpr float kNoSlope = 0.3f;    ///< a gradient shorter than this is that of the middle of a wall
inline constexpr float kShallow = 0.35f;   ///< of the depth: at edges there may be no slope above
inline constexpr float kMaxLifted = 3.0f;  ///< depths from which a particle is still put back

/// A place on the way, as the field has it.
struct Look {
  glm::vec3 at{0.0f};      ///< m, mesh frame
  glm::vec3 normal{0.0f};  ///< unit, out of the solid
  float distance = 0.0f;   ///< m
  float slope = 0.0f;      ///< length of the gradient: 1 but at edges and in the middle of a wall
};

SLOSH_HD inline Look look(const DistanceFieldView& field, const glm::vec3& at) {
  const DistanceSample s = sample_distance(field, at);
  const float slope = glm::length(s.gradient);
  return {at, slope > 0.0f ? s.gradient / slope : glm::vec3(0.0f), s.distance, slope};
}

/// In a solid whose way out is reversed since the look before: past the middle of a wall. Just within a
/// convex edge the field, which is coarse, has no slope either, but is not deep; nor is anybody kept who is
/// less deep than before.
SLOSH_HD inline bool past_middle(const Look& before, const Look& now, float depth) {
  if (before.distance < 0.0f && glm::dot(before.normal, now.normal) < -kNoSlope) return true;
  return now.slope < kNoSlope && now.distance < -kShallow * depth && now.distance <= before.distance;
}

/// Follows the straight way from `good` to `end`. True when it gets there; then, and else too, `good` is the
/// last place where a particle may be, and `bad` the first where it may not.
SLOSH_HD inline bool follow(const DistanceFieldView& field, float depth, const glm::vec3& end, Look& good,
                            Look& bad) {
  const glm::vec3 start = good.at;
  const glm::vec3 way = end - start;
  const float looks = glm::length(way) / (kStride * depth);
  const int count = looks < kMaxLooks - 1 ? static_cast<int>(looks) + 1 : kMaxLooks;
  for (int i = 1; i <= count; ++i) {
    const Look now = look(field, start + way * (static_cast<float>(i) / static_cast<float>(count)));
    if (now.distance < -depth || (now.distance < 0.0f && past_middle(good, now, depth))) {
      bad = now;
      return false;
    }
    // The way out from where there was a slope is known better than where there is none.
    const glm::vec3 out = now.slope < kNoSlope && now.distance < 0.0f ? good.normal : now.normal;
    good = now;
    good.normal = out;
  }
  return true;
}

}  // namespace penetration_clamp

/// Looks at a particle's way from `from` (m, world, as the sub-step began) to `x` against one body. A way
/// that leads deeper into the solid than ClampBody::depth, or through it, is bent: the particle slides on
/// along the wall, on the side that it came from, and loses that part of `v` (m/s) which goes into the wall.
/// True when that was so; else nothing is changed. All finite. A particle that was deep in the solid before
/// is left alone.
SLOSH_HD inline bool clamp_particle(const ClampBody& body, const glm::vec3& from, glm::vec3& x,
                                    glm::vec3& v) {
  using namespace penetration_clamp;
  const glm::vec3 begin = glm::transpose(body.before.turn) * (from - body.before.shift);
  glm::vec3 end = glm::transpose(body.after.turn) * (x - body.after.shift);
  // A ball around the end that holds the whole way is clear of the solid: nearly always so.
  const float ahead = sample_distance(body.field, end).distance;
  if (ahead >= 0.0f && ahead + body.depth >= glm::distance(begin, end)) return false;

  Look good = look(body.field, begin), bad;
  const float rest = -kRest * body.depth;
  bool caught = false;
  if (good.distance < -body.depth) {
    if (good.distance < -kMaxLifted * body.depth || good.slope < kNoSlope) return false;
    if (ahead >= good.distance) return false;  // on its way out
    good = look(body.field, good.at + good.normal * (rest - good.distance));
  }
  for (int turn = 0; turn < kMaxIterations; ++turn) {
    if (follow(body.field, body.depth, end, good, bad)) break;
    caught = true;
    // The wall that it met, or past its middle the side that it came from.
    const Look& wall = bad.slope < kNoSlope || past_middle(good, bad, body.depth) ? good : bad;
    const float lacks = rest - (wall.distance + glm::dot(end - wall.at, wall.normal));
    const glm::vec3 wanted = end;
    end = lacks > 0.0f ? end + wall.normal * lacks : wall.at + wall.normal * (rest - wall.distance);
    if (turn + 1 == kMaxIterations) end = good.at;
    const glm::vec3 of_wall = body.after.velocity_at(body.after.place(end));
    glm::vec3 normal = body.after.turn * wall.normal;
    float into = glm::dot(v - of_wall, normal);
    // Out of one wall and into the next, as between wires that the field hardly tells apart.
    if (into >= 0.0f && wanted != end) {
      normal = body.after.turn * glm::normalize(end - wanted);
      into = glm::dot(v - of_wall, normal);
    }
    if (into < 0.0f) v -= into * normal;
  }
  if (caught) x = body.after.place(end);
  return caught;
}

/// The same against all bodies, again until no way is bent any more: in a corner between two, one sends it to
/// the other. `body_at(i)` is the i-th, `sphere_at(i)` the ball that it lies in. `near`: there were body
/// particles in the cells around it as the sub-step began; else only fast bodies are looked at. Calls
/// taken(body, from, before) whenever one has bent it: where (m) and how fast (m/s) it would have been. True
/// when one did.
template <class SphereAt, class BodyAt, class Taken>
SLOSH_HD inline bool clamp_against_all(SphereAt&& sphere_at, BodyAt&& body_at, std::uint32_t count, bool near,
                                       const glm::vec3& from, glm::vec3& x, glm::vec3& v, Taken&& taken) {
  constexpr int kRounds = 3;
  bool any = false;
  // No shorter than the length, and no root.
  const auto length_at_most = [](const glm::vec3& d) {
    return std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  };
  float way = length_at_most(x - from);
  for (int round = 0; round < kRounds; ++round) {
    bool bent = false;
    for (std::uint32_t b = 0; b < count; ++b) {
      if (!sphere_at(b).meets(x, way)) continue;
      const ClampBody& body = body_at(b);
      if (!near && !body.fast) continue;
      const glm::vec3 to = x, before = v;
      if (!clamp_particle(body, from, x, v)) continue;
      taken(b, to, before);
      way = length_at_most(x - from);
      bent = true;
    }
    any |= bent;
    if (!bent) break;
  }
  return any;
}

}  // namespace slosh
