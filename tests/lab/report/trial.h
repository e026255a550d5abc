// One run of a scene at one setting, with what it cost.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "scenes/sample.h"
#include "scenes/scene.h"
#include "sim/world.h"
#include "tests/lab/report/refused.h"

namespace slosh::report {

inline constexpr double kGravity = 9.81;  ///< m/s², what Scene has unless told otherwise
inline constexpr double kPi = std::numbers::pi;
inline const glm::dvec3 kUp(0.0, 1.0, 0.0);

/// What a case is run with: one point of a report.
struct Setting {
  ParticleModel model = ParticleModel::kCorrected;
  double spacing = 0.01;        ///< m
  double support_ratio = 2.0;   ///< as Scene's
  double step_share = 1.0;      ///< of the plan's time step, > 0
  bool solve_viscosity = true;  ///< where the plan finds it worth it; else viscosity stays explicit
  Backend backend = Backend::kCpu;
  int threads = 0;              ///< of the CPU backend; 0 = all cores
  bool (*stopped)() = nullptr;  ///< asked each step; true ends the run: Trial throws Stopped
};

/// Summed over all worlds that a case ran.
struct Cost {
  std::uint64_t particles = 0;  ///< of the largest of them, fluid only
  std::uint64_t retired = 0;    ///< out of the world, spilled or lost
  std::uint64_t lost = 0;       ///< of these, as Diagnostics::lost
  std::uint64_t steps = 0;
  double time_step = 0.0;    ///< s, of the last
  double simulated_s = 0.0;  ///< settling is not in it
  double wall_s = 0.0;       ///< in World::step alone, no sampling and no reading
  std::uint32_t status = 0;  ///< StatusBits, of all steps
};

/// Setting::stopped said so.
struct Stopped : std::exception {
  const char* what() const noexcept override { return "stopped"; }
};

/// A scene that runs. Handles start disengaged, at their grips. Not copied, not moved.
class Trial {
 public:
  /// Samples the scene, with the setting's model and support. Throws Refused. `cost` must outlive it.
  Trial(const Scene& scene, const Setting& setting, Cost& cost);
  /// `settled`: as WorldOptions has it.
  Trial(const Scene& scene, const SampledScene& sampled, const Setting& setting, Cost& cost,
        bool settled = false);
  ~Trial();
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  World& world() { return *world_; }
  const BodySnapshot& bodies() const { return now_; }  ///< after the last step
  HandleInput& handle(std::size_t grip) { return handles_[grip]; }
  std::size_t grips() const { return handles_.size(); }
  double fluid_mass() const { return world_->diagnostics().mass; }
  const SampledScene& sampled() const { return sampled_; }

  void step();
  /// Steps for `seconds` of simulated time, at least one; `each` is called after every step.
  void run(double seconds, const std::function<void()>& each = {});
  /// World::settle for `seconds`, with the handles as they are where `held`.
  void settle(double seconds, bool held = false);
  /// The first handle's body, held still until now, is turned about the vertical at `turning` rad/s for
  /// `seconds`. After every step `each` is told the time since, s, and the torque against the fluid, N·m: a
  /// step's is that at its start.
  void turn(int body, double turning, double seconds,
            const std::function<void(double time, double torque)>& each);
  Snapshot picture() const;

 private:
  void end_if_stopped() const {
    if (stopped_ && stopped_()) throw Stopped();
  }
  void start(const Scene& scene, const Setting& setting, bool settled = false);

  SampledScene sampled_;
  std::unique_ptr<World> world_;
  BodySnapshot now_;
  std::vector<HandleInput> handles_;
  bool (*stopped_)();
  Cost& cost_;
};

/// The scene as a setting has it: its model and its support ratio.
Scene with_setting(Scene scene, const Setting& setting);
/// It sampled as it is run. Throws Refused.
SampledScene sampled_for(const Scene& scene, const Setting& setting);

/// Readings of one scalar over time.
class Average {
 public:
  void add(double value);
  std::size_t count() const { return values_.size(); }
  double mean() const;
  double median() const;
  /// Largest |value − mean| seen, in units of |mean|.
  double peak_share() const;
  /// Standard deviation in units of |mean|.
  double noise_share() const;

 private:
  std::vector<double> values_;
  double sum_ = 0.0;
};

/// True when every body and every particle that is still in the world is finite.
bool all_finite(const World& world);

}  // namespace slosh::report
