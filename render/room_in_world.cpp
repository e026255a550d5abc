#include "render/room_in_world.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

glm::dquat about_y(double angle) {
  return glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0));
}

/// Rad about y from −z to the level part of `way`; 0 for one that goes straight up or down.
double heading(const glm::dvec3& way) {
  return std::hypot(way.x, way.z) < 1e-9 ? 0.0 : std::atan2(-way.x, -way.z);
}

}  // namespace

Pose RoomInWorld::to_world(const Pose& in_room) const {
  const glm::dquat turn = about_y(turned);
  return {origin + turn * (scale * in_room.position), glm::normalize(turn * in_room.orientation)};
}

Twist RoomInWorld::to_world(const Twist& in_room) const {
  const glm::dquat turn = about_y(turned);
  return {turn * (scale * in_room.linear), turn * in_room.angular};
}

Pose RoomInWorld::to_room(const Pose& in_world) const {
  const glm::dquat back = about_y(-turned);
  return {back * (in_world.position - origin) / scale, glm::normalize(back * in_world.orientation)};
}

View eye_view(const EyeInRoom& eye, const RoomInWorld& room, double near_plane, double far_plane) {
  const Pose from_world = inverse(room.to_world(eye.pose));
  View view;
  view.view = glm::mat4(glm::mat4_cast(from_world.orientation));
  view.view[3] = glm::vec4(glm::vec3(from_world.position), 1.0f);
  const double width = eye.right - eye.left;
  const double height = eye.up - eye.down;
  view.projection = glm::mat4(0.0f);
  view.projection[0][0] = static_cast<float>(2.0 / width);
  view.projection[1][1] = static_cast<float>(2.0 / height);
  view.projection[2][0] = static_cast<float>((eye.right + eye.left) / width);
  view.projection[2][1] = static_cast<float>((eye.up + eye.down) / height);
  view.projection[2][2] = static_cast<float>(-(far_plane + near_plane) / (far_plane - near_plane));
  view.projection[2][3] = -1.0f;
  view.projection[3][2] = static_cast<float>(-2.0 * far_plane * near_plane / (far_plane - near_plane));
  view.near_plane = static_cast<float>(near_plane);
  view.far_plane = static_cast<float>(far_plane);
  return view;
}

View panel_view(const Pose& panel, const glm::dvec2& size, const glm::dvec3& eye, const RoomInWorld& room,
                double near_plane) {
  const glm::dvec3 middle = transform_point(inverse(Pose{eye, panel.orientation}), panel.position);
  const double away = std::max(-middle.z, 1e-6);
  const EyeInRoom through{Pose{eye, panel.orientation}, (middle.x - 0.5 * size.x) / away,
                          (middle.x + 0.5 * size.x) / away, (middle.y - 0.5 * size.y) / away,
                          (middle.y + 0.5 * size.y) / away};
  return eye_view(through, room, near_plane, std::max(away * room.scale, 2.0 * near_plane));
}

RoomInWorld anchor_room(const Pose& head, const AnchorWish& wish) {
  const double looks = heading(head.orientation * glm::dvec3(0.0, 0.0, -1.0));
  RoomInWorld room;
  room.scale = wish.scale;
  room.turned = heading(wish.facing) - looks;
  glm::dvec3 at = head.position + wish.distance * (about_y(looks) * glm::dvec3(0.0, 0.0, -1.0));
  at.y = wish.height >= 0.0 ? wish.height : head.position.y - wish.below_eyes;
  room.origin = wish.focus - room.scale * (about_y(room.turned) * at);
  return room;
}

}  // namespace slosh
