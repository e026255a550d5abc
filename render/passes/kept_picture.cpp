#include "render/passes/kept_picture.h"

#include <algorithm>
#include <cmath>

#include "render/passes/frame_block.h"
#include "render/passes/light_fit.h"

namespace slosh {
namespace {

/// Of a fluid's shadow: how far a particle's disc reaches past its centre in the picture or in the light's
/// map, where one disc stands for several, particle radii.
constexpr float kFluidReach = 4.0f;
constexpr float kDiscs = 8000.0f;

/// Beyond this a shadow is not followed, m.
constexpr float kFarthestShadow = 100.0f;

/// Eye and light of a picture.
class Projector {
 public:
  Projector(const Frame& frame, const Bounds& world, glm::ivec2 size, float shadow_texel)
      : clip_from_world_(frame.view.projection * frame.view.view),
        near_(frame.view.near_plane),
        to_light_(direction_to_light(frame)),
        world_(world),
        size_(size),
        texel_(shadow_texel) {}

  /// Where a box is seen, and what it may cast a shadow on. `pad`: m around it.
  PixelBox of(Bounds box, float pad) const {
    if (box.empty()) return {};
    // Shadows are softened over some texels of their map, and those of a fluid lie in one of a third of its
    // size.
    const float soft = 8.0f * texel_;
    box.low -= pad + soft;
    box.high += pad + soft;
    float way = 0.0f;
    if (texel_ > 0.0f) {
      for (int corner = 0; corner < 8; ++corner) way = std::max(way, way_out(box_corner(box, corner)));
    }
    glm::vec2 low(1e9f);
    glm::vec2 high(-1e9f);
    for (int corner = 0; corner < 8; ++corner) {
      for (const float along : {0.0f, way}) {
        const glm::vec4 clip =
            clip_from_world_ * glm::vec4(box_corner(box, corner) - along * to_light_, 1.0f);
        if (!(clip.w > near_)) return whole();  // beside or behind the eye, or no number
        const glm::vec2 at = (glm::vec2(clip) / clip.w + 1.0f) * 0.5f * glm::vec2(size_);
        low = glm::min(low, at);
        high = glm::max(high, at);
      }
    }
    const glm::vec2 most(size_);
    const PixelBox seen{glm::ivec2(glm::clamp(glm::floor(low), glm::vec2(0.0f), most)),
                        glm::ivec2(glm::clamp(glm::ceil(high), glm::vec2(0.0f), most))};
    return seen.grown(2, size_);
  }

  PixelBox whole() const { return {glm::ivec2(0), size_}; }

 private:
  /// How far light goes on from a point until it leaves the box of all bodies, m.
  float way_out(const glm::vec3& from) const {
    float way = kFarthestShadow;
    for (int axis = 0; axis < 3; ++axis) {
      const float speed = -to_light_[axis];
      if (std::abs(speed) < 1e-6f) continue;
      const float end = speed > 0.0f ? world_.high[axis] : world_.low[axis];
      way = std::min(way, (end - from[axis]) / speed);
    }
    return std::max(way, 0.0f);
  }

  glm::mat4 clip_from_world_;
  float near_;
  glm::vec3 to_light_;
  Bounds world_;
  glm::ivec2 size_;
  float texel_;
};

/// A box of a mesh's frame in the world; empty where that is not finite: it is not drawn.
Bounds in_world(const Bounds& own, const glm::mat4& model) {
  Bounds box;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 at(model * glm::vec4(box_corner(own, corner), 1.0f));
    if (!std::isfinite(at.x + at.y + at.z)) return {};
    box.add(at);
  }
  return box;
}

/// Empty for a mesh that is not known.
Bounds box_of(const MeshInstance& instance, const MeshStore& meshes) {
  return meshes.has(instance.mesh) ? in_world(meshes.bounds(instance.mesh), instance.model) : Bounds{};
}

/// The same of what is wet of it.
Bounds wet_box_of(const MeshInstance& instance) {
  const Wetness& wet = instance.wet;
  if (wet.version == 0) return {};
  // Half a cell beyond the outermost there is still some of it, and it is told before the face.
  const float pad = wet.cell + wet.off;
  return in_world(
      {wet.low + wet.cell * glm::vec3(wet.wet_low) - pad, wet.low + wet.cell * glm::vec3(wet.wet_high) + pad},
      instance.model);
}

PixelBox moving_parts(const Frame& frame, const Projector& seen) {
  Bounds fluid;
  const std::size_t count = std::min(frame.particles.size(), frame.particle_fluid.size());
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3& at = frame.particles[i];
    if (frame.particle_fluid[i] < frame.fluids.size() && std::isfinite(at.x + at.y + at.z)) fluid.add(at);
  }
  const float discs = std::max(std::cbrt(static_cast<float>(count) / kDiscs), 1.0f);
  PixelBox all = seen.of(fluid, kFluidReach * discs * frame.particle_radius);
  Bounds foam;
  float largest = 0.0f;
  for (const FoamPoint& point : frame.foam) {
    if (!std::isfinite(point.position.x + point.position.y + point.position.z + point.radius)) continue;
    foam.add(point.position);
    largest = std::max(largest, point.radius);
  }
  all.add(seen.of(foam, largest));
  const glm::vec3 eye(glm::inverse(frame.view.view)[3]);
  for (const Arrow& arrow : frame.arrows) {
    if (!std::isfinite(glm::dot(arrow.from + arrow.to, glm::vec3(1.0f)))) continue;
    Bounds box;
    box.add(arrow.from);
    box.add(arrow.to);
    all.add(
        seen.of(box, 0.02f * glm::distance(arrow.from, eye)));  // arrow_pass.cpp: its head's width, at most
  }
  return all;
}

bool same_bodies(const std::vector<MeshInstance>& a, const std::vector<MeshInstance>& b) {
  return std::ranges::equal(a, b, [](const MeshInstance& one, const MeshInstance& other) {
    return one.mesh == other.mesh && one.look == other.look;
  });
}

}  // namespace

void PixelBox::add(const PixelBox& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  low = glm::min(low, other.low);
  high = glm::max(high, other.high);
}

PixelBox PixelBox::grown(int pixels, glm::ivec2 size) const {
  if (empty()) return *this;
  return {glm::max(low - pixels, glm::ivec2(0)), glm::min(high + pixels, size)};
}

PixelBox KeptPicture::changed(const Frame& frame, const MeshStore& meshes, glm::ivec2 size,
                              float shadow_texel) {
  Bounds world;
  for (const MeshInstance& instance : frame.meshes) world.add(box_of(instance, meshes));
  const Projector seen(frame, world, size, shadow_texel);
  const PixelBox moving = moving_parts(frame, seen);
  PixelBox box = moving;
  const bool known = last_ && last_->view == frame.view && last_->light_direction == frame.light_direction &&
                     last_->size == size && last_->shadow_texel == shadow_texel &&
                     same_bodies(last_->meshes, frame.meshes);
  if (known) {
    box.add(last_->moving);
    for (std::size_t i = 0; i < frame.meshes.size(); ++i) {
      if (last_->meshes[i].wet != frame.meshes[i].wet) {
        box.add(seen.of(wet_box_of(last_->meshes[i]), 0.0f));
        box.add(seen.of(wet_box_of(frame.meshes[i]), 0.0f));
      }
      if (last_->meshes[i].model == frame.meshes[i].model) continue;
      box.add(seen.of(box_of(last_->meshes[i], meshes), 0.0f));
      box.add(seen.of(box_of(frame.meshes[i], meshes), 0.0f));
    }
  }
  last_ = Seen{frame.view, frame.light_direction, frame.meshes, size, shadow_texel, moving};
  return known ? box : seen.whole();
}

}  // namespace slosh
