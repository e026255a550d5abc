// Where in the picture what the hands hold is seen: the HUD's panels keep clear of it.
#pragma once

#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "peer/view/hud/panels.h"
#include "render/frame.h"
#include "scenes/scene.h"
#include "sim/snapshot.h"

namespace slosh {

class HeldRects {
 public:
  /// `scene` must outlive it.
  explicit HeldRects(const Scene& scene);

  /// One a grip: round the projected box of the body it holds and its handle. In shares of the picture, 0–1,
  /// y down; without what is behind the eye or beyond the far plane.
  std::vector<Rect> of(const Snapshot& snapshot, const View& view) const;
  /// The same with where the scene's own scripts are going to have them.
  std::vector<Rect> through_run(const Snapshot& snapshot, const View& view) const;

 private:
  /// Round the handle and the body that a grip holds, into `rects` where something of it is seen.
  void add(std::size_t grip, const glm::dvec3& handle, const Pose* body, const View& view,
           std::vector<Rect>& rects) const;

  const Scene& scene_;
  std::vector<std::pair<glm::vec3, glm::vec3>> boxes_;  // a grip each, in its body's mesh frame
};

}  // namespace slosh
