// The mouse takes hold of what the scripts hold: a handle, or a thing by all its handles.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "peer/haptics/shared_handle.h"
#include "peer/view/orbit_camera.h"
#include "render/input.h"
#include "scenes/scene.h"
#include "sim/snapshot.h"

namespace slosh {

/// What the pointer is over, or holds.
struct Grabbed {
  int body = -1;          ///< index into Scene::bodies
  int grip = -1;          ///< index into Scene::grips: one handle; −1 = all that are lent on the body
  glm::dvec3 place{0.0};  ///< m, world: the handle, or the point of the body under the pointer
};

/// On the window's thread, once a picture.
///
/// A press on a handle's ball takes that handle, a press on a body with lent handles takes all of these at
/// once. While the button is held, all lent hands of the body move as one rigid thing, so that nothing is
/// torn between a hand that goes and one that stays: with one handle held they turn about the others, which
/// give way when they are pulled. Let go of, they stay where they are until give_back().
class MouseGrab {
 public:
  explicit MouseGrab(const Scene& scene);

  /// `lent` has one entry a grip, null where that hand is not to be taken. `picture` in pixels. True while
  /// the mouse is busy with a thing, so that the camera leaves it alone.
  bool follow(const InputState& input, const OrbitCamera& camera, const glm::ivec2& picture,
              const BodySnapshot& world, const std::vector<SharedHandle*>& lent);
  /// All hands go home to their scripts.
  void give_back(const std::vector<SharedHandle*>& lent);

  const std::optional<Grabbed>& over() const { return over_; }  ///< what a press would take
  const std::optional<Grabbed>& held() const { return held_; }
  bool any_taken() const;
  bool taken(std::size_t grip) const { return grip < hands_.size() && hands_[grip].taken; }
  bool ever_tilted() const { return tilted_; }

 private:
  struct Hand {
    bool taken = false;
    Pose wanted;  // world, while taken
    Pose in_rig;  // in the frame that moves them together
    SharedHandle* of = nullptr;
  };
  std::optional<Grabbed> look(const glm::dvec2& pixel, const OrbitCamera& camera, const glm::ivec2& picture,
                              const BodySnapshot& world, const std::vector<SharedHandle*>& lent) const;
  std::optional<double> hit(int body, const Pose& pose, const glm::dvec3& eye, const glm::dvec3& ray) const;
  bool has_lent(int body, const std::vector<SharedHandle*>& lent) const;
  void take(const std::vector<SharedHandle*>& lent);
  void move(const InputState& input, const OrbitCamera& camera, const glm::ivec2& picture);
  void shift(const glm::dvec3& by);
  void tell() const;

  const Scene& scene_;
  std::vector<Hand> hands_;  // one a grip
  std::optional<Grabbed> over_;
  std::optional<Grabbed> held_;
  Pose rig_;                // world: what the held body's hands move with; about its place they turn
  bool pivots_ = false;     // one handle is held, and others that are ours are what it turns about
  glm::dvec3 handle_{0.0};  // m, world: where the held handle is wanted, while it pivots
  bool was_down_ = false;
  bool tilted_ = false;
};

}  // namespace slosh
