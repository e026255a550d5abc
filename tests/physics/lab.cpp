#include "tests/physics/lab.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "scenes/mesh/closed.h"

namespace slosh::lab {

namespace {

mesh::VolumeIntegrals integrals(const TriangleMesh& triangles) {
  const mesh::WeldedMesh welded = mesh::weld(triangles);
  mesh::Components parts;
  mesh::find_defects(welded, &parts);
  return mesh::integrate_volume(welded, parts);
}

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
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

Experiment::Experiment(const Scene& scene, double spacing) {
  Result<SampledScene> sampled = sample_scene(scene, spacing);
  if (!sampled) throw std::runtime_error(sampled.error().text());  // GoogleTest shows it and goes on
  sampled_ = std::move(sampled.value());
  start(scene);
}

Experiment::Experiment(const Scene& scene, const SampledScene& sampled) : sampled_(sampled) {
  start(scene);
}

void Experiment::start(const Scene& scene) {
  world_ = std::make_unique<World>(scene, sampled_, make_plan(scene, sampled_.spacing), WorldOptions{1, Backend::kCpu});
  handles_.resize(scene.grips.size());
  for (std::size_t g = 0; g < handles_.size(); ++g) {
    handles_[g].pose = compose(scene.bodies[scene.grips[g].body].pose, scene.grips[g].pose);
  }
  world_->fill(now_);
}

void Experiment::step() {
  world_->step(handles_);
  world_->fill(now_);
}

void Experiment::run(double seconds, const std::function<void()>& each) {
  const double dt = world_->plan().time_step;
  const long steps = std::max(1L, std::lround(seconds / dt));
  for (long i = 0; i < steps; ++i) {
    step();
    if (each) each();
  }
}

Snapshot Experiment::picture() const {
  Snapshot snapshot;
  world_->fill(snapshot);
  return snapshot;
}

void Average::add(double value) {
  values_.push_back(value);
  sum_ += value;
  count_ += 1.0;
}

double Average::peak_share() const {
  double peak = 0.0;
  for (const double v : values_) peak = std::max(peak, std::abs(v - mean()));
  return peak / std::abs(mean());
}

double Average::noise_share() const {
  double sum = 0.0;
  for (const double v : values_) sum += (v - mean()) * (v - mean());
  return std::sqrt(sum / count_) / std::abs(mean());
}

double report(const std::string& name, double measured, double predicted, const char* unit) {
  const double error = (measured - predicted) / predicted;
  char text[200];
  std::snprintf(text, sizeof text, "measured %.5g %s, predicted %.5g %s, error %+.2f %%", measured, unit,
                predicted, unit, 100.0 * error);
  std::printf("  %s: %s\n", name.c_str(), text);
  ::testing::Test::RecordProperty(name, text);
  return error;
}

void report_value(const std::string& name, double value, const char* unit) {
  char text[100];
  std::snprintf(text, sizeof text, "%.4g %s", value, unit);
  std::printf("  %s: %s\n", name.c_str(), text);
  ::testing::Test::RecordProperty(name, text);
}

bool all_finite(World& world) {
  Snapshot snapshot;
  world.fill(snapshot);
  for (std::size_t i = 0; i < snapshot.positions.size(); ++i) {
    if (snapshot.fluid_index[i] != 255 && !finite(glm::dvec3(snapshot.positions[i]))) return false;
  }
  return std::all_of(snapshot.rigid.bodies.begin(), snapshot.rigid.bodies.end(), [](const BodyState& b) {
    return finite(b.pose.position) && finite(b.twist.linear) && finite(b.twist.angular) &&
           finite(b.fluid.force) && finite(b.fluid.torque);
  });
}

}  // namespace slosh::lab
