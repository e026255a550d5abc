#include "sim/bodies/rigid_body.h"

namespace slosh {

RigidBody make_rigid_body(const Body& source) {
  RigidBody body;
  body.free = source.motion == BodyMotion::kFree;
  body.driven = source.motion == BodyMotion::kDriven;
  body.point = source.point_probe;
  body.local_center = body.free ? source.mass.center_of_mass : glm::dvec3(0.0);
  body.orientation = source.pose.orientation;
  body.position = transform_point(source.pose, body.local_center);
  if (body.free) {
    body.mass = source.mass.mass;
    body.inertia = body.point ? glm::dmat3(1.0) : source.mass.inertia;
    body.inverse_inertia = glm::inverse(body.inertia);
    body.velocity = source.twist.linear;
    body.angular_velocity = body.point ? glm::dvec3(0.0) : source.twist.angular;
    body.angular_momentum = body.world_inertia() * body.angular_velocity;
  }
  if (source.starts_away) put_away(body);
  return body;
}

void take_mass(RigidBody& body, const MassProperties& mass) {
  body.mass = mass.mass;
  body.inertia = mass.inertia;
  body.inverse_inertia = glm::inverse(mass.inertia);
  body.local_center = mass.center_of_mass;
}

RigidBody part_of(const RigidBody& body, const MassProperties& mass) {
  RigidBody part = body;
  take_mass(part, mass);
  part.position = transform_point(body.mesh_pose(), mass.center_of_mass);
  part.velocity = body.velocity_at(part.position);
  part.angular_momentum = part.world_inertia() * body.angular_velocity;
  return part;
}

void put_away(RigidBody& body) {
  body.gone = true;
  body.position = glm::dvec3(kAway);
  body.velocity = body.angular_momentum = body.angular_velocity = glm::dvec3(0.0);
}

}  // namespace slosh
