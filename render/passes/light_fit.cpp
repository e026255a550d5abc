#include "render/passes/light_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

namespace slosh {
namespace {

/// By how much what stands on a table may sink into it, m, and the table still be no caster.
constexpr float kSunk = 2e-3f;

using Corners = std::array<glm::vec3, 8>;

Corners corners_of(const Bounds& box, const glm::mat4& model) {
  Corners corners;
  for (int corner = 0; corner < 8; ++corner)
    corners[static_cast<std::size_t>(corner)] = glm::vec3(model * glm::vec4(box_corner(box, corner), 1.0f));
  return corners;
}

/// Some side of the mesh's box faces the light and has all of `points` before it: no ray from them to the
/// light meets the mesh.
bool all_before_a_lit_side(const Caster& mesh, const Corners& points, const glm::vec3& to_light) {
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const glm::vec3 normal = (side % 2 ? 1.0f : -1.0f) * glm::vec3(mesh.model[axis]);
    if (glm::dot(normal, to_light) <= 0.0f) continue;
    glm::vec3 on_side = mesh.box.low;
    if (side % 2) on_side = mesh.box.high;
    const float level = glm::dot(normal, glm::vec3(mesh.model * glm::vec4(on_side, 1.0f)));
    if (std::ranges::all_of(points,
                            [&](const glm::vec3& p) { return glm::dot(normal, p) >= level - kSunk; })) {
      return true;
    }
  }
  return false;
}

/// What the eye sees of a box of the world, as a box in light axes; larger, never smaller.
Bounds seen_box(const View& view, const Bounds& world, const glm::mat4& light_from_world) {
  float farthest = view.near_plane;
  for (const glm::vec3& corner : corners_of(world, view.view)) farthest = std::max(farthest, -corner.z);
  farthest = std::min(farthest, view.far_plane);
  const glm::mat4 world_from_eye = glm::inverse(view.view);
  const glm::mat4& p = view.projection;
  Bounds seen;
  for (const float depth : {view.near_plane, farthest}) {
    for (const float x : {-1.0f, 1.0f}) {
      for (const float y : {-1.0f, 1.0f}) {
        const glm::vec3 eye((x + p[2][0]) / p[0][0] * depth, (y + p[2][1]) / p[1][1] * depth, -depth);
        seen.add(glm::vec3(light_from_world * world_from_eye * glm::vec4(eye, 1.0f)));
      }
    }
  }
  return seen;
}

}  // namespace

glm::vec3 box_corner(const Bounds& box, int corner) {
  return {(corner & 1) ? box.high.x : box.low.x, (corner & 2) ? box.high.y : box.low.y,
          (corner & 4) ? box.high.z : box.low.z};
}

LightFit fit_light(std::span<const Caster> meshes, const Bounds& fluid, std::span<const View> views,
                   const glm::vec3& to_light) {
  const glm::vec3 up =
      std::abs(to_light.y) > 0.99f ? glm::vec3(0.0f, 0.0f, 1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
  LightFit fit;
  fit.light_from_world = glm::lookAt(glm::vec3(0.0f), -to_light, up);
  // What flew beyond the far plane of the eye is taken to be there.
  const View& view = views.front();
  const glm::vec3 eye(glm::inverse(view.view)[3]);
  std::vector<Corners> things;
  for (const Caster& mesh : meshes) things.push_back(corners_of(mesh.box, mesh.model));
  if (!fluid.empty()) things.push_back(corners_of(fluid, glm::mat4(1.0f)));
  Bounds everything;
  Bounds all;
  Bounds casting;
  for (std::size_t i = 0; i < things.size(); ++i) {
    bool casts = i >= meshes.size() || !meshes[i].convex;
    for (std::size_t j = 0; j < things.size() && !casts; ++j)
      casts = j != i && !all_before_a_lit_side(meshes[i], things[j], to_light);
    if (i < meshes.size()) fit.casts.push_back(casts);
    for (const glm::vec3& corner : things[i]) {
      const glm::vec3 near = glm::clamp(corner, eye - view.far_plane, eye + view.far_plane);
      everything.add(near);
      const glm::vec3 lit(fit.light_from_world * glm::vec4(near, 1.0f));
      all.add(lit);
      if (casts) casting.add(lit);
    }
  }
  fit.box = all;
  if (all.empty()) return fit;
  Bounds seen;
  for (const View& each : views) seen.add(seen_box(each, everything, fit.light_from_world));
  const Bounds& wanted = casting.empty() ? all : casting;
  const glm::vec3 low = glm::max(wanted.low, seen.low);
  const glm::vec3 high = glm::min(wanted.high, seen.high);
  for (int axis = 0; axis < 2; ++axis) {
    const bool meet = low[axis] < high[axis];
    fit.box.low[axis] = meet ? low[axis] : wanted.low[axis];
    fit.box.high[axis] = meet ? high[axis] : wanted.high[axis];
  }
  return fit;
}

glm::mat4 light_clip_from_world(const LightFit& fit, int size) {
  const glm::vec3 span = glm::max(fit.box.high - fit.box.low, glm::vec3(1e-3f));
  const float extent = std::exp2(std::ceil(4.0f * std::log2(std::max(span.x, span.y) * 1.02f)) / 4.0f);
  const float texel = extent / static_cast<float>(size);
  const glm::vec2 center = glm::floor(0.5f * glm::vec2(fit.box.low + fit.box.high) / texel) * texel;
  const float margin = 0.01f * span.z + 1e-3f;
  return glm::ortho(center.x - 0.5f * extent, center.x + 0.5f * extent, center.y - 0.5f * extent,
                    center.y + 0.5f * extent, -fit.box.high.z - margin, -fit.box.low.z + margin) *
         fit.light_from_world;
}

}  // namespace slosh
