// One snapshot to one picture: camera, frame and HUD together.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "peer/view/foam.h"
#include "peer/view/frame_builder.h"
#include "peer/view/held_rects.h"
#include "peer/view/hud/hud.h"
#include "peer/view/orbit_camera.h"
#include "peer/view/stereo_views.h"
#include "render/headset.h"

namespace slosh {

/// For a run's summary, after the renderer's name; empty where it is as everywhere.
inline std::string where_particles_are_read(const Renderer& renderer) {
  return renderer.reads_particles_on_gpu() ? ", particles read where CUDA has them" : "";
}

/// On the renderer's thread. The scene must outlive it.
class Painter {
 public:
  Painter(const Scene& scene, const HudFacts& facts, Renderer& renderer)
      : renderer_(renderer),
        builder_(scene, facts.spacing, renderer),
        foam_(scene, facts.spacing),
        camera_(scene.camera),
        hud_(scene, facts),
        held_(scene) {}

  /// As FrameBuilder's.
  void show_ghost(const std::vector<GuidedHand>& hands) { builder_.show_ghost(hands); }

  /// A new snapshot for the charts and the foam.
  void record(const Snapshot& snapshot) {
    hud_.record(snapshot);
    foam_.record(snapshot);
  }

  /// `over`: Dear ImGui calls after the HUD's own; may be empty.
  void draw(const Snapshot& snapshot, const Rates& rates, const std::function<void()>& over = {}) {
    Frame frame = builder_.build(snapshot, camera_.distance());
    frame.foam = foam_.points();
    const RenderOptions& size = renderer_.options();
    frame.view = camera_.view(static_cast<double>(size.width) / size.height);
    if (!hud_.placed()) hud_.keep_clear = held_.through_run(snapshot, frame.view);
    frame.hud = [this, &rates, &over] {
      hud_.draw(rates);
      if (over) over();
    };
    renderer_.draw(frame);
  }

  /// Both eyes of a headset, and the HUD on its panel where that is to be drawn. `controllers` in the world,
  /// which is `scale` m a m of the room. `keep`: null, or gets both pictures side by side.
  void draw(const HeadsetPictures& pictures, const Snapshot& snapshot, const Rates& rates,
            std::span<const Pose> controllers, double scale, Image* keep) {
    Frame frame = builder_.build(snapshot, camera_.distance());
    frame.foam = foam_.points();
    for (const Pose& pose : controllers) builder_.add_controller(pose, scale, frame);
    // The panel stands behind the scene and would be drawn over what is lifted before it.
    for (const View& eye : pictures.panel_views) {
      if (pictures.panel.texture == 0 || hud_.placed()) break;
      for (const Rect& rect : held_.through_run(snapshot, eye)) hud_.keep_clear.push_back(rect);
    }
    frame.hud = [this, &rates] { hud_.draw(rates); };
    const RenderOptions& size = renderer_.options();
    if (size.width != pictures.size.x || size.height != pictures.size.y)
      renderer_.resize(pictures.size.x, pictures.size.y);
    renderer_.prepare(frame, pictures.views);
    renderer_.draw(pictures.views, pictures.targets);  // a window shows the first, the left one
    if (pictures.panel.texture != 0) renderer_.draw_panel(pictures.panel_size, pictures.panel);
    if (keep) *keep = side_by_side(renderer_.read_back(0), renderer_.read_back(1));
  }

  /// Both eyes of a film (stereo_views.h), drawn together, the HUD over each, in the screen: side by side.
  Image draw_both(const Snapshot& snapshot, const Rates& rates) {
    Frame frame = builder_.build(snapshot, camera_.distance());
    frame.foam = foam_.points();
    const RenderOptions& size = renderer_.options();
    frame.view = camera_.view(static_cast<double>(size.width) / size.height);
    if (!hud_.placed()) hud_.keep_clear = held_.through_run(snapshot, frame.view);
    frame.hud = [this, &rates] { hud_.draw(rates); };
    const std::array<View, 2> eyes =
        stereo_views(frame.view, kEyesApart, static_cast<float>(camera_.distance()));
    renderer_.prepare(frame, eyes);
    std::array<Image, 2> read;
    renderer_.draw(eyes, {});
    for (std::size_t eye = 0; eye < 2; ++eye) {
      renderer_.draw_hud(eye);
      read[eye] = renderer_.read_back(eye);
    }
    renderer_.present();
    return side_by_side(read[0], read[1]);
  }

  /// The studio without a scene, for a headset that waits.
  void draw_nothing(const HeadsetPictures& pictures) {
    if (renderer_.options().width != pictures.size.x || renderer_.options().height != pictures.size.y)
      renderer_.resize(pictures.size.x, pictures.size.y);
    renderer_.prepare({}, pictures.views);
    renderer_.draw(pictures.views, pictures.targets);
    if (pictures.panel.texture != 0) renderer_.draw_panel(pictures.panel_size, pictures.panel);
  }

  /// As FrameBuilder's.
  const std::vector<Error>& left_out() const { return builder_.left_out(); }

  OrbitCamera& camera() { return camera_; }
  Hud& hud() { return hud_; }

 private:
  Renderer& renderer_;
  FrameBuilder builder_;
  Foam foam_;
  OrbitCamera camera_;
  Hud hud_;
  HeldRects held_;
};

}  // namespace slosh
