#include "sim/bodies/driven_bodies.h"

#include <algorithm>
#include <cmath>

#include "sim/bodies/body_solve.h"

namespace slosh {
namespace {

// Times the fluid's mass. Their twists stay to a millionth, and doubles still hold what the fluid gives.
constexpr double kHeavy = 1e6;
constexpr double kMinFluid = 1e-3;  // kg
constexpr double kMinReach = 1e-3;  // m

}  // namespace

Pose pose_at(std::span<const PoseKey> keys, bool repeats, double time) {
  const double last = keys.back().time;
  if (repeats && last > 0.0 && time > last) time = std::fmod(time, last);
  const auto above = std::upper_bound(keys.begin(), keys.end(), time,
                                      [](double t, const PoseKey& key) { return t < key.time; });
  if (above == keys.begin()) return keys.front().pose;
  if (above == keys.end()) return keys.back().pose;
  const PoseKey& from = *(above - 1);
  const double share = (time - from.time) / (above->time - from.time);
  if (share == 0.0) return from.pose;
  return {glm::mix(from.pose.position, above->pose.position, share),
          rotate_by(from.pose.orientation,
                    share * rotation_between(from.pose.orientation, above->pose.orientation))};
}

DrivenBodies::DrivenBodies(const Scene& scene, const SampledScene& sampled) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (body.motion != BodyMotion::kDriven) continue;
    Driven driven{static_cast<int>(b), body.keys, body.repeats, kMinReach, body.pose};
    if (driven.keys.empty()) driven.keys.push_back({0.0, body.pose});
    for (const glm::vec3& p : sampled.surfaces[b].positions)
      driven.reach = std::max(driven.reach, static_cast<double>(glm::length(p)));
    driven_.push_back(std::move(driven));
  }
  double densest = 0.0;
  for (const Fluid& fluid : scene.fluids) densest = std::max(densest, fluid.rest_density);
  mass_ = kHeavy * std::max(kMinFluid, densest * static_cast<double>(sampled.fluid_positions.size()) *
                                           std::pow(sampled.spacing, 3));
}

void DrivenBodies::drive(std::vector<RigidBody>& bodies, double until, double dt) {
  for (Driven& driven : driven_) {
    RigidBody& body = bodies[static_cast<std::size_t>(driven.body)];
    if (body.gone) {
      stand(body, driven);
      continue;
    }
    driven.target = pose_at(driven.keys, driven.repeats, until);
    body.velocity = (driven.target.position - body.position) / dt;
    body.angular_velocity = rotation_between(body.orientation, driven.target.orientation) / dt;
  }
}

void DrivenBodies::stand(std::vector<RigidBody>& bodies) {
  for (Driven& driven : driven_) stand(bodies[static_cast<std::size_t>(driven.body)], driven);
}

void DrivenBodies::stand(RigidBody& body, Driven& driven) {
  driven.target = {body.position, body.orientation};
  body.velocity = body.angular_velocity = glm::dvec3(0.0);
}

Pose DrivenBodies::pose_of(int body, double time) const {
  const Driven& driven = of(body);
  return pose_at(driven.keys, driven.repeats, time);
}

void DrivenBodies::move(std::vector<RigidBody>& bodies) const {
  for (const Driven& driven : driven_) {
    RigidBody& body = bodies[static_cast<std::size_t>(driven.body)];
    body.position = driven.target.position;
    body.orientation = driven.target.orientation;
  }
}

const DrivenBodies::Driven& DrivenBodies::of(int body) const {
  return *std::find_if(driven_.begin(), driven_.end(), [&](const Driven& d) { return d.body == body; });
}

RigidBody DrivenBodies::moved(const RigidBody& body, int index) const {
  RigidBody out = body;
  out.position = of(index).target.position;
  out.orientation = of(index).target.orientation;
  return out;
}

ViscousBody DrivenBodies::as_heavy(const RigidBody& body, int index) const {
  ViscousBody heavy;
  heavy.moves = true;
  heavy.twist = {body.velocity, body.angular_velocity};
  const Vector6 twist = body_solve::twist_of(body);
  const double reach = of(index).reach;
  for (int i = 0; i < 6; ++i) {
    heavy.inertia[i][i] = i < 3 ? mass_ : mass_ * reach * reach;
    heavy.momentum[i] = heavy.inertia[i][i] * twist[i];
  }
  return heavy;
}

}  // namespace slosh
