// One snapshot to one picture: camera, frame and HUD together.
#pragma once

#include <functional>
#include <memory>

#include "peer/hud/hud.h"
#include "peer/view/frame_builder.h"
#include "peer/view/held_rects.h"
#include "peer/view/orbit_camera.h"

namespace slosh {

/// On the renderer's thread. The scene must outlive it.
class Painter {
 public:
  Painter(const Scene& scene, const HudFacts& facts, Renderer& renderer)
      : renderer_(renderer),
        builder_(scene, facts.spacing, renderer),
        camera_(scene.camera),
        hud_(scene, facts),
        held_(scene) {}

  /// A new snapshot for the charts.
  void record(const Snapshot& snapshot) { hud_.record(snapshot); }

  /// `over`: Dear ImGui calls after the HUD's own; may be empty.
  void draw(const Snapshot& snapshot, const Rates& rates, const std::function<void()>& over = {}) {
    Frame frame = builder_.build(snapshot, camera_.distance());
    const RenderOptions& size = renderer_.options();
    frame.view = camera_.view(static_cast<double>(size.width) / size.height);
    hud_.keep_clear = held_.of(snapshot, frame.view);
    frame.hud = [this, &rates, &over] {
      hud_.draw(rates);
      if (over) over();
    };
    renderer_.draw(frame);
  }

  OrbitCamera& camera() { return camera_; }
  Hud& hud() { return hud_; }

 private:
  Renderer& renderer_;
  FrameBuilder builder_;
  OrbitCamera camera_;
  Hud hud_;
  HeldRects held_;
};

}  // namespace slosh
