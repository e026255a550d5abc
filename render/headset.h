// A headset, by OpenXR: both eyes' pictures go there, head and hands come from there. No XR and no GL types
// here.
#pragma once

#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>

#include "render/context.h"
#include "render/headset_hands.h"
#include "render/renderer.h"
#include "render/room_in_world.h"
#include "sim/math/result.h"

namespace slosh {

enum class HeadsetState : std::uint8_t {
  kAway,     ///< the runtime wants no pictures now: the headset is not worn, or another program has it
  kHidden,   ///< pictures are to be paced and handed over, and are not seen
  kVisible,  ///< they are seen; hands belong to something else, a menu for example
  kFocused,  ///< and hands are ours
  kLost,     ///< runtime or headset went away; start() may be tried again
  kEnded,    ///< the person ended the program in the runtime's own menu
};

struct HeadsetOptions {
  double resolution = 1.0;           ///< of the size a side that the runtime recommends, 0.1–2
  glm::ivec2 panel_size{1024, 640};  ///< pixels of the HUD's panel
  double near_plane = 0.03;          ///< m of the world
  double far_plane = 20.0;           ///< m of the world
};

/// Where the HUD stands: the middle of an upright rectangle that faces its +z.
struct HeadsetPanel {
  Pose pose;             ///< in the room
  glm::dvec2 size{0.0};  ///< m of the room; 0: no panel
  bool renewed = true;   ///< its picture is to be drawn anew; else the last one stays
};

/// Where things are for one frame.
struct HeadsetPlaces {
  RoomInWorld room;
  HeadsetPanel panel;
};

/// What is to be drawn in one frame.
struct HeadsetPictures {
  std::array<View, 2> views;             ///< left, right; in the world
  std::array<PictureTarget, 2> targets;  ///< of `size` pixels each
  glm::ivec2 size{0};
  PictureTarget panel;  ///< for Renderer::draw_panel; texture 0: not now
  glm::ivec2 panel_size{0};
  /// The panel as each eye sees it (panel_view()): it has no depth, so it is to be left clear where something
  /// is before it.
  std::array<View, 2> panel_views;
};

/// The thread of the context makes all calls but those of hands().
class Headset {
 public:
  /// Looks for a runtime and a headset; nothing is drawn yet. Errors: no runtime, no headset, a runtime that
  /// takes no pictures from OpenGL.
  static Result<std::unique_ptr<Headset>> find(const HeadsetOptions& options);
  virtual ~Headset() = default;
  Headset(const Headset&) = delete;
  Headset& operator=(const Headset&) = delete;

  /// The runtime's and the headset's names.
  virtual std::string description() const = 0;
  /// Whether pictures of a context of GLFW's (a window) or of EGL's (none) can be handed over.
  virtual bool takes_window() const = 0;
  virtual bool takes_headless() const = 0;

  /// Begins to use it with `context`, which is current here and must outlive stop(). Again after kLost: the
  /// runtime is looked for anew. Errors: as find(); what the runtime refuses.
  virtual Result<bool> start(Context& context) = 0;
  virtual void stop() = 0;

  /// Takes in what the runtime said. Before each frame(), and now and then while kAway.
  virtual HeadsetState poll() = 0;
  /// In kHidden, kVisible and kFocused: waits until the runtime wants the next pictures, has `draw` draw them
  /// where they are to be seen, and hands them over; `places` is asked before that, with the head in the
  /// room. False where none were: then `draw` was not called, or the runtime refused what it drew. A refusal
  /// costs this frame; the thirtieth in a row is a loss.
  virtual bool frame(const std::function<HeadsetPlaces(const Pose& head)>& places,
                     const std::function<void(const HeadsetPictures&)>& draw) = 0;

  /// In the room, at the last frame(); nothing before it is known.
  virtual std::optional<Pose> head() const = 0;
  /// Whether the room's origin lies on the floor; else it is where the head was at the start.
  virtual bool floor_known() const = 0;
  /// s between two frames, as the runtime last said; 0 = not known yet.
  virtual double period() const = 0;
  /// What went wrong since the last call, for a person; empty when nothing did.
  virtual std::string take_problem() = 0;
  /// Never null; goes on, without anything tracked, when the headset is gone.
  virtual std::shared_ptr<HeadsetHands> hands() = 0;

 protected:
  Headset() = default;
};

}  // namespace slosh
