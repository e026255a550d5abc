#include "tests/lab/report/scene_builder.h"

#include "scenes/mesh/closed.h"

namespace slosh::report {
namespace {

constexpr int kAround = 96;  // faces of a round vessel

mesh::VolumeIntegrals integrals(const TriangleMesh& triangles) {
  const mesh::WeldedMesh welded = mesh::weld(triangles);
  mesh::Components parts;
  mesh::find_defects(welded, &parts);
  return mesh::integrate_volume(welded, parts);
}

}  // namespace

int SceneBuilder::add_mesh(const make::Solid& solid) {
  scene.meshes.push_back(make::with_normals(solid));
  return static_cast<int>(scene.meshes.size()) - 1;
}

int SceneBuilder::add_fluid(double rest_density, double viscosity) {
  Fluid fluid;
  fluid.name = "fluid";
  fluid.rest_density = rest_density;
  fluid.dynamic_viscosity = viscosity;
  scene.fluids.push_back(fluid);
  return static_cast<int>(scene.fluids.size()) - 1;
}

int SceneBuilder::add_volume(const make::Solid& solid, int fluid, const Pose& pose) {
  FluidVolume volume;
  volume.name = "volume";
  volume.mesh = add_mesh(solid);
  volume.fluid = fluid;
  volume.pose = pose;
  scene.fluid_volumes.push_back(volume);
  return static_cast<int>(scene.fluid_volumes.size()) - 1;
}

int SceneBuilder::add_fixed(const std::string& name, const make::Solid& solid, const Pose& pose) {
  Body body;
  body.name = name;
  body.mesh = add_mesh(solid);
  body.measured = true;
  body.pose = pose;
  scene.bodies.push_back(body);
  return static_cast<int>(scene.bodies.size()) - 1;
}

int SceneBuilder::add_free(const std::string& name, const make::Solid& solid, double mass, const Pose& pose) {
  const int index = add_fixed(name, solid, pose);
  Body& body = scene.bodies[index];
  const mesh::VolumeIntegrals solid_integrals = integrals(scene.meshes[body.mesh]);
  body.motion = BodyMotion::kFree;
  body.mass.mass = mass;
  body.mass.center_of_mass = solid_integrals.centroid;
  body.mass.inertia = solid_integrals.inertia * (mass / solid_integrals.volume);
  return index;
}

int SceneBuilder::add_grip(int body, double stiffness, double damping, double rotational_stiffness,
                           double rotational_damping, const Pose& pose) {
  Grip grip;
  grip.name = "grip";
  grip.body = body;
  grip.pose = pose;
  grip.stiffness = stiffness;
  grip.damping = damping;
  grip.rotational_stiffness = rotational_stiffness;
  grip.rotational_damping = rotational_damping;
  scene.grips.push_back(grip);
  return static_cast<int>(scene.grips.size()) - 1;
}

int SceneBuilder::add_stiff_grip(int body) {
  return add_grip(body, 1e5, 1e3, 1e4, 1e3);
}

void SceneBuilder::set_viscosity(std::initializer_list<int> bodies, double viscosity) {
  for (const int body : bodies) scene.bodies[static_cast<std::size_t>(body)].dynamic_viscosity = viscosity;
}

void SceneBuilder::set_domain(const glm::dvec3& lower, const glm::dvec3& upper) {
  scene.domain_min = lower;
  scene.domain_max = upper;
}

double volume_of(const make::Solid& solid) {
  return integrals(make::with_normals(solid)).volume;
}

make::Solid tank_at_floor(const glm::dvec3& inner, double wall) {
  make::Solid solid = make::tank(inner, wall);
  for (glm::dvec3& p : solid.points) p.y -= wall;
  return solid;
}

make::Solid glass_of(double radius, double height, double wall, double hole) {
  const double outer = radius + wall;
  return make::lathe(
      {{hole, -wall}, {outer, -wall}, {outer, height}, {radius, height}, {radius, 0.0}, {hole, 0.0}},
      kAround);
}

make::Solid filling_of(double radius, double height) {
  return make::lathe({{0.0, 0.0}, {radius, 0.0}, {radius, height}, {0.0, height}}, kAround);
}

}  // namespace slosh::report
