// What a person does in the window, to the run, the camera and the hands; and what the window says of it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "peer/app/live_run.h"
#include "peer/view/force_panel.h"
#include "peer/view/kept_views.h"
#include "peer/view/measures.h"
#include "peer/view/mouse_grab.h"
#include "peer/view/mouse_hand.h"
#include "peer/view/orbit_camera.h"
#include "peer/view/window_guide.h"
#include "render/input.h"

namespace slosh {

/// On the window's thread; one a run.
class WindowControls {
 public:
  /// All but `views` must outlive it. `tell`: a line for the terminal.
  WindowControls(const Scene& scene, LiveRun& run, OrbitCamera& camera, KeyBindings keys, KeptViews views,
                 std::function<void(const std::string&)> tell);

  /// Turns of the surface's filter (RenderOptions::bilateral_iterations): as it is, and as the slider wants
  /// it.
  int filter = 0;

  enum class Wish { kNothing, kEnd, kPicture };
  /// Once a picture, with the newest state of the bodies (none yet: null). `picture` in pixels.
  Wish follow(const InputState& input, const glm::ivec2& picture, const BodySnapshot* world);
  /// A new snapshot, for what is drawn and plotted over the picture.
  void record(const Snapshot& snapshot);
  /// Dear ImGui calls, inside Frame::hud, over the picture of `snapshot`. `taken`: where panels lie already.
  void draw(const Snapshot& snapshot, const glm::ivec2& picture, std::span<const Rect> taken);
  /// The table of forces that somebody asked to keep since the last call.
  std::optional<std::string> take_forces() { return forces_.take_table(); }
  /// In the window and in the terminal.
  void say(const std::string& text);

 private:
  Wish follow_keys(const InputState& input);
  Wish follow_key(WindowAction action, bool shift);
  void follow_pace(WindowAction action, bool shift);
  void follow_view(std::size_t number, bool keep);
  void follow_mouse(const InputState& input, const glm::ivec2& picture, const BodySnapshot& world);
  void follow_mouse_hands(const InputState& input, const glm::ivec2& picture);
  void learn(const glm::ivec2& picture);
  void reset_hands();

  const Scene& scene_;
  LiveRun& run_;
  OrbitCamera& camera_;
  std::function<void(const std::string&)> tell_;
  MouseGrab grab_;
  KeyBindings keys_;
  WindowGuide guide_;
  Measures measures_;
  ForcePanel forces_;
  KeptViews views_;
  LivePanel panel_;
  GuideFacts facts_;
  std::vector<SharedHandle*> lent_;  // one a grip, as the run has them now
  struct Hand {
    MouseTarget* target = nullptr;
    MouseHand mouse{Pose{}};
  };
  std::vector<Hand> hands_;  // of --device mouse
};

}  // namespace slosh
