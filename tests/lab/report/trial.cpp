#include "tests/lab/report/trial.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace slosh::report {
namespace {

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

Scene with_setting(Scene scene, const Setting& setting) {
  scene.model = setting.model;
  scene.support_ratio = setting.support_ratio;
  return scene;
}

SampledScene sampled_for(const Scene& scene, const Setting& setting) {
  Result<SampledScene> found = sample_scene(with_setting(scene, setting), setting.spacing);
  if (!found) throw Refused(found.error());
  return std::move(found.value());
}

Trial::Trial(const Scene& scene, const Setting& setting, Cost& cost)
    : sampled_(sampled_for(scene, setting)), stopped_(setting.stopped), cost_(cost) {
  start(with_setting(scene, setting), setting);
}

Trial::Trial(const Scene& scene, const SampledScene& sampled, const Setting& setting, Cost& cost,
             bool settled)
    : sampled_(sampled), stopped_(setting.stopped), cost_(cost) {
  start(with_setting(scene, setting), setting, settled);
}

Trial::~Trial() {
  if (!world_) return;
  cost_.status |= world_->take_status();
  const Diagnostics fluid = world_->diagnostics();
  cost_.retired += fluid.retired;
  cost_.lost += fluid.lost;
  cost_.particles = std::max<std::uint64_t>(cost_.particles, world_->fluid_count());
}

void Trial::start(const Scene& scene, const Setting& setting, bool settled) {
  Plan plan = make_plan(scene, sampled_.spacing, setting.solve_viscosity);
  plan.time_step *= setting.step_share;
  plan.max_speed = speed_limit(plan, plan.time_step);
  Result<World> made = make_world(scene, sampled_, plan, {setting.threads, setting.backend, settled});
  if (!made) throw Refused(made.error());
  world_ = std::make_unique<World>(std::move(made.value()));
  cost_.time_step = plan.time_step;
  handles_.resize(scene.grips.size());
  for (std::size_t g = 0; g < handles_.size(); ++g) {
    const Grip& grip = scene.grips[g];
    handles_[g].pose = compose(scene.bodies[static_cast<std::size_t>(grip.body)].pose, grip.pose);
  }
  world_->fill(now_);
}

void Trial::step() {
  end_if_stopped();
  const auto before = std::chrono::steady_clock::now();
  world_->step(handles_);
  cost_.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  cost_.simulated_s += world_->plan().time_step;
  cost_.steps += 1;
  world_->fill(now_);
}

void Trial::run(double seconds, const std::function<void()>& each) {
  const long steps = std::max(1L, std::lround(seconds / world_->plan().time_step));
  for (long i = 0; i < steps; ++i) {
    step();
    if (each) each();
  }
}

void Trial::settle(double seconds, bool held) {
  end_if_stopped();
  world_->settle(seconds, held ? std::span<const HandleInput>(handles_) : std::span<const HandleInput>(),
                 stopped_);
  end_if_stopped();
  world_->fill(now_);
}

void Trial::turn(int body, double turning, double seconds,
                 const std::function<void(double time, double torque)>& each) {
  HandleInput& hand = handles_.front();
  hand.twist.angular.y = turning;
  const double start = world_->time();
  run(seconds, [&] {
    const double time = world_->time() - start;
    hand.pose.orientation = glm::angleAxis(turning * time, kUp);
    each(time, -now_.bodies[static_cast<std::size_t>(body)].fluid.torque.y);
  });
}

Snapshot Trial::picture() const {
  Snapshot snapshot;
  world_->fill(snapshot);
  return snapshot;
}

void Average::add(double value) {
  values_.push_back(value);
  sum_ += value;
}

double Average::mean() const {
  return sum_ / static_cast<double>(values_.size());
}

double Average::median() const {
  std::vector<double> sorted = values_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

double Average::peak_share() const {
  double peak = 0.0;
  for (const double v : values_) peak = std::max(peak, std::abs(v - mean()));
  return peak / std::abs(mean());
}

double Average::noise_share() const {
  double sum = 0.0;
  for (const double v : values_) sum += (v - mean()) * (v - mean());
  return std::sqrt(sum / static_cast<double>(values_.size())) / std::abs(mean());
}

bool all_finite(const World& world) {
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

}  // namespace slosh::report
