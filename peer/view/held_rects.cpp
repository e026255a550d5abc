#include "peer/view/held_rects.h"

#include <algorithm>

#include "peer/haptics/pose_track.h"
#include "peer/view/frame_builder.h"

namespace slosh {

namespace {
constexpr int kLooks = 24;  // along a script
}

HeldRects::HeldRects(const Scene& scene) : scene_(scene) {
  for (const Grip& grip : scene.grips) {
    glm::vec3 low(0.0f);
    glm::vec3 high(0.0f);
    const int mesh = grip.body < 0 ? -1 : scene.bodies[static_cast<std::size_t>(grip.body)].mesh;
    if (mesh >= 0 && !scene.meshes[static_cast<std::size_t>(mesh)].positions.empty()) {
      const auto& positions = scene.meshes[static_cast<std::size_t>(mesh)].positions;
      low = high = positions.front();
      for (const glm::vec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
    }
    boxes_.emplace_back(low, high);
  }
}

void HeldRects::add(std::size_t grip, const glm::dvec3& handle, const Pose* body, const View& view,
                    std::vector<Rect>& rects) const {
  std::vector<glm::vec3> points{glm::vec3(handle)};
  if (body) {
    const glm::mat4 model = model_matrix(*body);
    const auto& [low, high] = boxes_[grip];
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 at(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                         corner & 4 ? high.z : low.z);
      points.emplace_back(model * glm::vec4(at, 1.0f));
    }
  }
  Rect rect{glm::vec2(1e9f), glm::vec2(-1e9f)};
  for (const glm::vec3& point : points) {
    const glm::vec4 clip = view.projection * view.view * glm::vec4(point, 1.0f);
    if (!(clip.w > view.near_plane && clip.w < view.far_plane)) continue;  // a NaN too
    const glm::vec2 at(0.5f + 0.5f * clip.x / clip.w, 0.5f - 0.5f * clip.y / clip.w);
    rect.low = glm::min(rect.low, at);
    rect.high = glm::max(rect.high, at);
  }
  if (rect.low.x <= rect.high.x) rects.push_back(rect);
}

std::vector<Rect> HeldRects::of(const Snapshot& snapshot, const View& view) const {
  std::vector<Rect> rects;
  for (std::size_t i = 0; i < boxes_.size() && i < snapshot.rigid.grips.size(); ++i) {
    const auto body = static_cast<std::size_t>(scene_.grips[i].body);
    const bool there = scene_.grips[i].body >= 0 && body < snapshot.rigid.bodies.size();
    add(i, snapshot.rigid.grips[i].handle.position, there ? &snapshot.rigid.bodies[body].pose : nullptr, view,
        rects);
  }
  return rects;
}

std::vector<Rect> HeldRects::through_run(const Snapshot& snapshot, const View& view) const {
  std::vector<Rect> rects = of(snapshot, view);
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Grip& grip = scene_.grips[i];
    PoseTrack track(grip.hand_motion, grip.pose);
    if (!track.moves()) continue;
    for (int k = 1; k <= kLooks; ++k) {
      const Pose handle = track.at(track.end() * k / kLooks).pose;
      const Pose body = compose(handle, inverse(grip.pose));
      add(i, handle.position, grip.body >= 0 ? &body : nullptr, view, rects);
    }
  }
  return rects;
}

}  // namespace slosh
