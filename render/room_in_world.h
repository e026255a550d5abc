// Where the room that a headset tracks lies in the world. Plain maths, no XR and no GL.
#pragma once

#include "render/frame.h"
#include "sim/math/pose.h"

namespace slosh {

/// The room (m, y up) as a part of the world: turned about the vertical alone, so that level stays level,
/// scaled and moved. Constant while a person looks: the world never moves the head.
struct RoomInWorld {
  glm::dvec3 origin{0.0};  ///< m, world: the room's own origin
  double turned = 0.0;     ///< rad about y, room to world
  double scale = 1.0;      ///< m of the world a m of the room, > 0: with 0.5 the world looks twice as large

  Pose to_world(const Pose& in_room) const;
  Twist to_world(const Twist& in_room) const;
  Pose to_room(const Pose& in_world) const;
};

/// One eye as the runtime has it.
struct EyeInRoom {
  Pose pose;  ///< looks down its −z
  /// Tangents of the picture's four sides; left and down are below 0 as a rule.
  double left = -1.0;
  double right = 1.0;
  double down = -1.0;
  double up = 1.0;
};

/// The eye in the world. Planes in m of the world.
View eye_view(const EyeInRoom& eye, const RoomInWorld& room, double near_plane, double far_plane);

/// An upright rectangle (its middle, facing its +z, and its size, m of the room) as an eye at `eye` sees it,
/// with nothing round it: what is seen before it hides that part of it. What is behind it is beyond the far
/// plane.
View panel_view(const Pose& panel, const glm::dvec2& size, const glm::dvec3& eye, const RoomInWorld& room,
                double near_plane);

/// What somebody wants to have before them.
struct AnchorWish {
  glm::dvec3 focus{0.0};              ///< m, world: what hands go to
  glm::dvec3 facing{0.0, 0.0, -1.0};  ///< the way to look at it; what is upright in it does not count
  double scale = 1.0;                 ///< as RoomInWorld::scale
  double distance = 0.5;              ///< m of the room, level, from the head to the focus
  double below_eyes = 0.35;           ///< m of the room, where `height` is not said
  double height = -1.0;               ///< m of the room from its origin up to the focus; below 0 = not said
};
/// The room placed so that who stands with the head at `head` has the focus before them.
RoomInWorld anchor_room(const Pose& head, const AnchorWish& wish);

}  // namespace slosh
