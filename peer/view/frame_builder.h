// Scene and snapshot → Frame.
#pragma once

#include <optional>
#include <vector>

#include "peer/haptics/guidance.h"
#include "peer/view/body_walls.h"
#include "peer/view/body_wetness.h"
#include "render/frame.h"
#include "render/renderer.h"
#include "scenes/scene.h"
#include "sim/snapshot.h"

namespace slosh {

/// Hands the scene's meshes over once and places them for every snapshot. On the thread of what draws them.
class FrameBuilder {
 public:
  /// `scene` and `meshes` must outlive it. `spacing` in m.
  FrameBuilder(const Scene& scene, double spacing, MeshSink& meshes);

  /// The returned frame points into `snapshot` and this, which must live until it is drawn. Without view and
  /// HUD. `view_distance` (m, eye to target) sizes the force arrows.
  Frame build(const Snapshot& snapshot, double view_distance);
  /// From now on the bodies that these hands held are shown too, translucent, where a recorded run had them
  /// by then, or at that point of its task: guidance's ways (peer/haptics/guidance.h).
  void show_ghost(const std::vector<GuidedHand>& hands);
  /// A hand's controller at `pose`, so that one sees one's own hands.
  void add_controller(const Pose& pose, double scale, Frame& frame) const;
  /// Textures that are not shown because their picture cannot be unpacked, one an image.
  const std::vector<Error>& left_out() const { return left_out_; }

 private:
  struct Placed {
    MeshHandle whole;
    MeshHandle mesh;  // what cuts left of it
    int body;         // index, or −1 for a picture
    MeshLook look;
    glm::mat4 model;  // of a picture
    std::vector<CutPlane> planes{};
  };
  struct Ghost {
    std::size_t grip;
    PoseTrack way;  // of the handle
    MeshHandle mesh;
    std::shared_ptr<const GhostClock> clock;
  };
  class Textures;

  void add_ghosts(const BodySnapshot& rigid, Frame& frame);
  void follow_cuts(const BodyCuts* cuts);

  const Scene& scene_;
  MeshSink& meshes_;
  std::shared_ptr<const BodyCuts> cuts_;
  std::vector<Error> left_out_;
  std::vector<Placed> placed_;
  std::vector<Ghost> ghosts_;
  std::vector<FluidLook> fluids_;
  std::optional<BodyWalls> walls_;  // made when first asked for
  BodyWetness wetness_;
  MeshHandle ball_ = 0;
  float particle_radius_;
  double reference_force_ = 1.0;  // N that an arrow of full length stands for: the largest so far
};

/// A ball of radius 1 about the origin.
TriangleMesh unit_ball();
glm::mat4 model_matrix(const Pose& pose);

}  // namespace slosh
