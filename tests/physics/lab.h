// What the experiments share: building a scene in code, running it, and reporting a measurement against its
// closed form.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "scenes/make/solid.h"
#include "scenes/sample.h"
#include "scenes/scene.h"
#include "sim/world.h"

namespace slosh::lab {

inline constexpr double kGravity = 9.81;  ///< m/s², what Scene has unless told otherwise
inline constexpr double kPi = 3.14159265358979323846;

/// A scene under construction. Each add returns the index of what was added.
struct SceneBuilder {
  Scene scene;

  int add_fluid(double rest_density, double viscosity);  ///< kg/m³, Pa·s
  int add_volume(const make::Solid& solid, int fluid = 0, const Pose& pose = {});
  /// A fixed body; its wrench is measured.
  int add_fixed(const std::string& name, const make::Solid& solid, const Pose& pose = {});
  /// A free body of uniform density: centre and inertia from the mesh.
  int add_free(const std::string& name, const make::Solid& solid, double mass, const Pose& pose = {});
  /// A grip at the origin of the body's mesh frame unless a pose is given.
  int add_grip(int body, double stiffness, double damping, double rotational_stiffness = 0.0,
               double rotational_damping = 0.0, const Pose& pose = {});
  void set_domain(const glm::dvec3& lower, const glm::dvec3& upper);

 private:
  int add_mesh(const make::Solid& solid);
};

/// m³, of a closed solid.
double volume_of(const make::Solid& solid);

/// An open box tank whose inner floor lies at y = 0, walls `wall` m thick.
make::Solid tank_at_floor(const glm::dvec3& inner, double wall);

/// A scene that runs. Handles start disengaged, at their grips.
class Experiment {
 public:
  /// Samples the scene; an error of the sampler fails the test with its text. One thread, so that experiments
  /// can run beside each other.
  Experiment(const Scene& scene, double spacing);
  Experiment(const Scene& scene, const SampledScene& sampled);

  World& world() { return *world_; }
  const BodySnapshot& bodies() const { return now_; }  ///< after the last step
  HandleInput& handle(std::size_t grip) { return handles_[grip]; }
  double fluid_mass() const { return world_->diagnostics().mass; }
  const SampledScene& sampled() const { return sampled_; }

  void step();
  /// Steps for `seconds` of simulated time, at least one; `each` is called after every step.
  void run(double seconds, const std::function<void()>& each = {});
  Snapshot picture() const;

 private:
  void start(const Scene& scene);

  SampledScene sampled_;
  std::unique_ptr<World> world_;
  BodySnapshot now_;
  std::vector<HandleInput> handles_;
};

/// Running mean and peak deviation of a scalar.
class Average {
 public:
  void add(double value);
  double mean() const { return sum_ / count_; }
  /// Largest |value − mean| seen, in units of |mean|.
  double peak_share() const;
  /// Standard deviation in units of |mean|.
  double noise_share() const;

 private:
  std::vector<double> values_;
  double sum_ = 0.0;
  double count_ = 0.0;
};

/// Prints "name: measured x, predicted y, error z %" and records it; returns (measured −
/// predicted)/predicted.
double report(const std::string& name, double measured, double predicted, const char* unit);
/// Prints and records a number that has no prediction.
void report_value(const std::string& name, double value, const char* unit);

/// True when every body and every particle that is still in the world is finite.
bool all_finite(World& world);

}  // namespace slosh::lab
