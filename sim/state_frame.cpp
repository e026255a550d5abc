// What must match for a saved world to fit.
#include "sim/hash.h"
#include "sim/saved_state.h"

namespace slosh {

StateFrame state_frame(const Scene& scene, const Plan& plan, const ParticleStart& start) {
  Fingerprint print;
  // Rounded, so that the last bit of a sum does not tell one machine's build from another's.
  const auto real = [&](double value) { print.add(static_cast<float>(value)); };
  const auto vector = [&](const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i) real(v[i]);
  };
  vector(scene.gravity);
  vector(scene.domain_min);
  vector(scene.domain_max);
  real(scene.support_ratio);
  real(plan.tension);
  print.add(static_cast<std::uint32_t>(plan.model));
  for (const Fluid& fluid : scene.fluids) {
    real(fluid.rest_density);
    real(fluid.dynamic_viscosity);
  }
  for (const Body& body : scene.bodies) {
    print.add(static_cast<std::uint32_t>(body.motion));
    print.add(static_cast<std::uint32_t>(body.point_probe));
    vector(body.pose.position);
    for (const double part :
         {body.pose.orientation.w, body.pose.orientation.x, body.pose.orientation.y, body.pose.orientation.z,
          body.dynamic_viscosity, body.friction, body.restitution, body.particle_density}) {
      real(part);
    }
    if (body.motion != BodyMotion::kFree) continue;
    real(body.mass.mass);
    vector(body.mass.center_of_mass);
    for (int i = 0; i < 3; ++i) vector(body.mass.inertia[i]);
  }
  // What is not there adds nothing: states that were saved before there was such a thing still fit.
  for (const Body& body : scene.bodies) {
    if (body.motion != BodyMotion::kDriven) continue;
    print.add(static_cast<std::uint32_t>(body.repeats));
    for (const PoseKey& key : body.keys) {
      real(key.time);
      vector(key.pose.position);
      for (const double part :
           {key.pose.orientation.w, key.pose.orientation.x, key.pose.orientation.y, key.pose.orientation.z})
        real(part);
    }
  }
  bool cuts = false;
  for (const Body& body : scene.bodies) {
    cuts |= is_cut(body);
    if (!is_cut(body) && !body.blade) continue;
    for (const int number : {body.pieces, body.piece_of, body.blade ? 1 : 0}) print.add(number);
    real(body.cut_n_m);
  }
  for (const Joint& joint : scene.joints) {
    for (const int number : {static_cast<int>(joint.kind), joint.body, joint.other}) print.add(number);
    vector(joint.pose.position);
    for (const double part : {joint.pose.orientation.w, joint.pose.orientation.x, joint.pose.orientation.y,
                              joint.pose.orientation.z, joint.lower, joint.upper, joint.damping,
                              joint.motor_speed, joint.motor_limit})
      real(part);
    if (!joint.changes()) continue;
    for (const double part : {joint.breaks_force, joint.breaks_torque, joint.joins_within, joint.joins_turn,
                              joint.starts_apart ? 1.0 : 0.0})
      real(part);
    if (!joint.meets) continue;
    vector(joint.meets->position);
    for (const double part : {joint.meets->orientation.w, joint.meets->orientation.x,
                              joint.meets->orientation.y, joint.meets->orientation.z})
      real(part);
  }
  for (const Grip& grip : scene.grips) {
    print.add(static_cast<std::uint32_t>(grip.body));
    vector(grip.pose.position);
    for (const double part :
         {grip.stiffness, grip.damping, grip.rotational_stiffness, grip.rotational_damping}) {
      real(part);
    }
  }
  if (plan.has(PassId::kHeat)) {
    for (const Fluid& fluid : scene.fluids) {
      const Heat& h = fluid.heat;
      for (const double part :
           {h.temperature, h.capacity, h.conductivity, h.sets_above, h.sets_below, h.sets_in, h.melts_above,
            h.melts_in, h.set_times, h.modulus, h.tears_at, h.starts_set ? 1.0 : 0.0})
        real(part);
      for (const Heat::Point& point : h.viscosity) {
        real(point.temperature);
        real(point.times);
      }
    }
    for (const Body& body : scene.bodies) real(body.temperature.value_or(kColdest - 1.0));
  }
  for (const std::uint8_t kind : start.particles.kind) print.add(kind);
  return {start.fluid_count,   start.probes.size(), start.fixed.size() + start.moving.size(),
          scene.bodies.size(), scene.grips.size(),  scene.fluids.size(),
          scene.joints.size(), plan.spacing,        plan.time_step,
          plan.stiffness,      print.value(),       cuts};
}

}  // namespace slosh
