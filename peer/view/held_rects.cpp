#include "peer/view/held_rects.h"

#include <algorithm>

#include "peer/view/frame_builder.h"

namespace slosh {

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

std::vector<Rect> HeldRects::of(const Snapshot& snapshot, const View& view) const {
  std::vector<Rect> rects;
  for (std::size_t i = 0; i < boxes_.size() && i < snapshot.rigid.grips.size(); ++i) {
    std::vector<glm::vec3> points{glm::vec3(snapshot.rigid.grips[i].handle.position)};
    const auto body = static_cast<std::size_t>(scene_.grips[i].body);
    if (scene_.grips[i].body >= 0 && body < snapshot.rigid.bodies.size()) {
      const glm::mat4 model = model_matrix(snapshot.rigid.bodies[body].pose);
      const auto& [low, high] = boxes_[i];
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
  return rects;
}

}  // namespace slosh
