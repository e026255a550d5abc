#include "tests/net/wire/same_scene.h"

#include <gtest/gtest.h>

namespace slosh::test {
namespace {

template <class T>
bool same(const T& a, const T& b) {
  return a == b;
}
bool same(const Pose& a, const Pose& b) {
  return a.position == b.position && a.orientation == b.orientation;
}
bool same(const Twist& a, const Twist& b) {
  return a.linear == b.linear && a.angular == b.angular;
}

void expect_same_keys(const std::vector<PoseKey>& a, const std::vector<PoseKey>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].time, b[k].time);
    EXPECT_TRUE(same(a[k].pose, b[k].pose));
  }
}

}  // namespace

#define SAME(field) EXPECT_TRUE(same(a.field, b.field)) << #field

void expect_same_scene(const Scene& a, const Scene& b) {
  SAME(name);
  SAME(title);
  SAME(source_file);
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  ASSERT_EQ(a.fluids.size(), b.fluids.size());
  ASSERT_EQ(a.images.size(), b.images.size());
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    SAME(images[i].name);
    SAME(images[i].bytes);
  }
  ASSERT_EQ(a.fluid_volumes.size(), b.fluid_volumes.size());
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  ASSERT_EQ(a.pictures.size(), b.pictures.size());
  ASSERT_EQ(a.grips.size(), b.grips.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    SAME(meshes[i].name);
    SAME(meshes[i].positions);
    SAME(meshes[i].normals);
    SAME(meshes[i].triangles);
    SAME(meshes[i].texcoords);
  }
  for (std::size_t i = 0; i < a.fluids.size(); ++i) {
    SAME(fluids[i].name);
    SAME(fluids[i].rest_density);
    SAME(fluids[i].dynamic_viscosity);
    SAME(fluids[i].color);
    SAME(fluids[i].extinction);
    SAME(fluids[i].gloss);
    SAME(fluids[i].refraction);
    SAME(fluids[i].scattering);
    SAME(fluids[i].roughness);
    SAME(fluids[i].heat);
  }
  for (std::size_t i = 0; i < a.fluid_volumes.size(); ++i) {
    SAME(fluid_volumes[i].name);
    SAME(fluid_volumes[i].mesh);
    SAME(fluid_volumes[i].fluid);
    SAME(fluid_volumes[i].pose);
    SAME(fluid_volumes[i].velocity);
    SAME(fluid_volumes[i].starts_away);
    SAME(fluid_volumes[i].fillings);
    SAME(fluid_volumes[i].body);
  }
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    SAME(bodies[i].name);
    SAME(bodies[i].mesh);
    SAME(bodies[i].motion);
    SAME(bodies[i].point_probe);
    SAME(bodies[i].pose);
    SAME(bodies[i].twist);
    SAME(bodies[i].mass.mass);
    SAME(bodies[i].mass.center_of_mass);
    SAME(bodies[i].mass.inertia);
    SAME(bodies[i].particle_density);
    SAME(bodies[i].dynamic_viscosity);
    SAME(bodies[i].friction);
    SAME(bodies[i].restitution);
    SAME(bodies[i].measured);
    SAME(bodies[i].material);
    SAME(bodies[i].temperature);
    SAME(bodies[i].repeats);
    SAME(bodies[i].starts_away);
    SAME(bodies[i].pieces);
    SAME(bodies[i].piece_of);
    SAME(bodies[i].cut_n_m);
    SAME(bodies[i].blade);
    expect_same_keys(a.bodies[i].keys, b.bodies[i].keys);
  }
  for (std::size_t i = 0; i < a.pictures.size(); ++i) {
    SAME(pictures[i].name);
    SAME(pictures[i].mesh);
    SAME(pictures[i].pose);
    SAME(pictures[i].material);
  }
  for (std::size_t i = 0; i < a.grips.size(); ++i) {
    SAME(grips[i].name);
    SAME(grips[i].body);
    SAME(grips[i].pose);
    SAME(grips[i].stiffness);
    SAME(grips[i].damping);
    SAME(grips[i].rotational_stiffness);
    SAME(grips[i].rotational_damping);
    expect_same_keys(a.grips[i].hand_motion, b.grips[i].hand_motion);
  }
  ASSERT_EQ(a.joints.size(), b.joints.size());
  for (std::size_t i = 0; i < a.joints.size(); ++i) {
    SAME(joints[i].name);
    SAME(joints[i].kind);
    SAME(joints[i].body);
    SAME(joints[i].other);
    SAME(joints[i].pose);
    SAME(joints[i].lower);
    SAME(joints[i].upper);
    SAME(joints[i].damping);
    SAME(joints[i].motor_speed);
    SAME(joints[i].motor_limit);
    SAME(joints[i].breaks_force);
    SAME(joints[i].breaks_torque);
    SAME(joints[i].joins_within);
    SAME(joints[i].joins_turn);
    SAME(joints[i].starts_apart);
    ASSERT_EQ(a.joints[i].meets.has_value(), b.joints[i].meets.has_value());
    if (a.joints[i].meets) {
      SAME(joints[i].meets->position);
      SAME(joints[i].meets->orientation);
    }
  }
  ASSERT_EQ(a.gauges.size(), b.gauges.size());
  for (std::size_t i = 0; i < a.gauges.size(); ++i) {
    SAME(gauges[i].name);
    SAME(gauges[i].body);
    SAME(gauges[i].position);
  }
  ASSERT_EQ(a.regions.size(), b.regions.size());
  for (std::size_t i = 0; i < a.regions.size(); ++i) {
    SAME(regions[i].name);
    SAME(regions[i].mesh);
    SAME(regions[i].body);
    SAME(regions[i].pose);
  }
  SAME(task);
  SAME(camera.eye);
  SAME(camera.target);
  SAME(camera.vertical_fov_deg);
  SAME(light_direction);
  SAME(gravity);
  SAME(spacing);
  SAME(spacing_min);
  SAME(spacing_max);
  SAME(support_ratio);
  SAME(model);
  SAME(stiffness);
  SAME(tension);
  SAME(duration);
  SAME(settle);
  SAME(domain_min);
  SAME(domain_max);
}

}  // namespace slosh::test
