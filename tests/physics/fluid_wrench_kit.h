// Worlds whose hands follow a path at 1 kHz and at 100 Hz, and what the models of the one say of the other.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "scenes/load.h"
#include "scenes/sample.h"
#include "sim/fluid_models.h"
#include "sim/stopwatch.h"
#include "tests/physics/lab.h"

namespace slosh::lab {

inline constexpr double kFine = 0.001;  // s: a consumer's period
inline constexpr int kRatio = 10;       // of a host at 100 Hz to that
/// Of all hands from where they start, m, by simulated s.
using Path = std::function<glm::dvec3(double)>;

/// A ball of 40 mm on a rod, held at the rod's top, in 1.5 dm³ of fluid of so many Pa·s.
inline Scene spoon_in(double viscosity) {
  SceneBuilder b;
  b.add_fluid(1000.0, viscosity);
  b.add_volume(make::box({-0.08, 0.0, -0.06}, {0.08, 0.08, 0.06}));
  const int tank = b.add_fixed("tank", tank_at_floor({0.16, 0.14, 0.12}, 0.02));
  const int spoon =
      b.add_free("spoon", make::merged(make::sphere(0.02, 24, 32), make::capsule(0.006, 0.017, 0.15, 10, 20)),
                 0.08, {{0.0, 0.04, 0.0}, {1.0, 0.0, 0.0, 0.0}});
  b.set_viscosity({tank, spoon}, kFluidsViscosity);
  b.add_grip(spoon, 1000.0, 20.0, 10.0, 0.2, {{0.0, 0.13, 0.0}, {1.0, 0.0, 0.0, 0.0}});
  b.set_domain({-0.3, -0.1, -0.3}, {0.3, 0.5, 0.3});
  return b.scene;
}

/// A world whose hands follow a path, and the models of the bodies that they hold.
class Host {
 public:
  /// `ratio`: fine steps in one of its own, in each of which the particles step all the same.
  Host(const Scene& scene, const SampledScene& sampled, int ratio)
      : world_(make(scene, sampled, ratio)), models_(scene), wanted_(scene.bodies.size(), 0) {
    world_.fill(now_);
    for (const Grip& grip : scene.grips) wanted_[static_cast<std::size_t>(grip.body)] = 1;
    for (const GripState& grip : now_.grips) hands_.push_back({grip.pose, {}, true, 1.0});
    start_ = hands_;
    world_.settle(0.5, hands_);
  }
  void step(const Path& path) {
    const double t = world_.time();
    for (std::size_t h = 0; h < hands_.size(); ++h) {
      hands_[h].pose.position = start_[h].pose.position + path(t);
      hands_[h].twist.linear = (path(t + 1e-5) - path(t)) / 1e-5;
    }
    before_ = now_;
    world_.step(hands_);
    world_.fill(now_);
    Stopwatch watch;
    models_.after_step(world_, now_, wanted_, out_);
    modelling_ += watch.lap();
    stepping_ += world_.times().total;
  }
  /// Wall time of the models in units of the steps'.
  double cost() const { return modelling_ / stepping_; }
  const std::vector<FluidWrenchModel>& models() const { return out_; }
  const World& world() const { return world_; }
  const BodySnapshot& now() const { return now_; }
  double time() const { return world_.time(); }
  Pose center(std::size_t body) const {
    return {now_.bodies[body].center_of_mass, now_.bodies[body].pose.orientation};
  }
  const Twist& twist(std::size_t body) const { return now_.bodies[body].twist; }
  const Wrench& wrench(std::size_t body) const { return world_.fluid_wrenches()[body]; }
  /// Of the body in the last step, m/s², rad/s².
  Vector6 acceleration(std::size_t body) const {
    const Twist& a = before_.bodies[body].twist;
    const Twist& b = twist(body);
    const glm::dvec3 linear = (b.linear - a.linear) / world_.plan().time_step;
    const glm::dvec3 angular = (b.angular - a.angular) / world_.plan().time_step;
    return {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
  }

 private:
  static World make(const Scene& scene, const SampledScene& sampled, int ratio) {
    Plan plan = make_plan(scene, sampled.spacing);
    EXPECT_GE(plan.time_step, kFine) << "the particles' own step is to be a fine one";
    plan.sub_steps = ratio;
    plan.time_step = ratio * kFine;
    plan.max_speed = speed_limit(plan, kFine);
    return {scene, sampled, plan, WorldOptions{1, Backend::kCpu}};
  }
  World world_;
  FluidModels models_;
  std::vector<char> wanted_;
  BodySnapshot now_, before_;
  std::vector<HandleInput> hands_, start_;
  std::vector<FluidWrenchModel> out_;
  double modelling_ = 0.0, stepping_ = 0.0;
};

/// The wrench that a body moved by the model feels: its added mass is in its inertia there.
inline Wrench felt(const FluidWrenchModel& model, const Host& fine, std::size_t body) {
  Wrench w = fluid_wrench(model, fine.center(body), fine.twist(body), fine.time() - model.time);
  const Vector6 a = fine.acceleration(body);
  for (int i = 0; i < 6; ++i) {
    double inertial = 0.0;
    for (int j = 0; j < 6; ++j) inertial += model.added_mass[i][j] * a[j];
    (i < 3 ? w.force[i] : w.torque[i - 3]) -= inertial;
  }
  return w;
}

inline FluidWrenchModel held(const Wrench& wrench) {
  FluidWrenchModel model;
  model.wrench = wrench;
  return model;
}

/// Differences from the fine host, with what repeats each state of the coarse one taken out of them.
class Difference {
 public:
  void add(const Wrench& said, const Wrench& is, int phase) {
    const std::complex<double> turn = std::polar(1.0, -2.0 * kPi * phase / kRatio);
    const std::array<glm::dvec3, 2> off{said.force - is.force, said.torque - is.torque};
    const std::array<glm::dvec3, 2> signal{is.force, is.torque};
    for (std::size_t part = 0; part < 2; ++part) {
      off_[part] += glm::dot(off[part], off[part]);
      sum_[part] += signal[part];
      square_[part] += glm::dot(signal[part], signal[part]);
      for (int i = 0; i < 3; ++i) tone_[part][static_cast<std::size_t>(i)] += off[part][i] * turn;
    }
    count_ += 1.0;
  }
  /// RMS of the difference, in units of the signal's about its mean. 0 force, 1 torque.
  double share(std::size_t part) const { return std::sqrt(off_[part] / count_) / signal(part); }
  /// Amplitude at the coarse host's rate, in the same units.
  double tone(std::size_t part) const {
    double most = 0.0;
    for (const std::complex<double>& axis : tone_[part]) most = std::max(most, 2.0 * std::abs(axis) / count_);
    return most / signal(part);
  }
  double signal(std::size_t part) const {
    return std::sqrt(square_[part] / count_ - glm::dot(sum_[part], sum_[part]) / (count_ * count_));
  }

 private:
  std::array<double, 2> off_{}, square_{};
  std::array<glm::dvec3, 2> sum_{glm::dvec3(0.0), glm::dvec3(0.0)};
  std::array<std::array<std::complex<double>, 3>, 2> tone_{};
  double count_ = 0.0;
};

struct Judged {
  Difference model, hold;
  double cost = 0.0;  ///< Host::cost of the fine one
};

/// Both hosts along the same path; from `from` s on the coarse one's models are judged over the ten
/// milliseconds that begin `late` s after each of its states, one answer for each of `late`.
inline std::vector<Judged> judge(const Scene& scene, double spacing, const Path& path, double seconds,
                                 double from, const std::vector<double>& late = {0.0}) {
  const auto sampled = sample_scene(scene, spacing);
  if (!sampled) throw std::runtime_error(sampled.error().text());
  Host fine(scene, sampled.value(), 1);
  Host coarse(scene, sampled.value(), kRatio);
  const auto body = static_cast<std::size_t>(scene.grips.front().body);
  std::vector<std::pair<FluidWrenchModel, Wrench>> given;
  std::vector<Judged> judged(late.size());
  while (coarse.time() < seconds) {
    coarse.step(path);
    given.emplace_back(coarse.models().at(0), coarse.wrench(body));
    if (given.size() == 1)
      for (int i = 0; i < kRatio; ++i) fine.step(path);
    // The fine host is now where the newest state is.
    for (int i = 1; i <= kRatio; ++i) {
      fine.step(path);
      if (fine.time() < from) continue;
      for (std::size_t l = 0; l < late.size(); ++l) {
        const auto wait = static_cast<std::size_t>(std::lround(late[l] / (kRatio * kFine)));
        const auto& [model, wrench] = given.at(given.size() - 1 - wait);
        judged[l].model.add(felt(model, fine, body), fine.wrench(body), i);
        judged[l].hold.add(felt(held(wrench), fine, body), fine.wrench(body), i);
        judged[l].cost = fine.cost();
      }
    }
  }
  return judged;
}

inline void tell(const std::string& name, const Judged& j) {
  report_value(name + ", force, the model", 100.0 * j.model.share(0), "%");
  report_value(name + ", force, the last one held", 100.0 * j.hold.share(0), "%");
  report_value(name + ", torque, the model", 100.0 * j.model.share(1), "%");
  report_value(name + ", torque, the last one held", 100.0 * j.hold.share(1), "%");
  report_value(name + ", tone at the host's rate, the model", 100.0 * j.model.tone(0), "%");
  report_value(name + ", tone at the host's rate, the last one held", 100.0 * j.hold.tone(0), "%");
  report_value(name + ", rms of the force about its mean", j.model.signal(0), "N");
  report_value(name + ", wall time of the models at 1 kHz", 100.0 * j.cost, "% of the steps'");
}

}  // namespace slosh::lab
