#include "tests/lab/coupling/particle_host.h"

#include <cmath>
#include <numbers>

#include "scenes/load.h"

namespace slosh::coupling {
namespace {

constexpr double kSettles = 2.0;  // s
constexpr double kHostRounding = 1e-9;

Scene held_by(const Case& c) {
  Scene scene = c.bucket->scene;
  const Grip first = scene.grips[0];
  const double radius = std::abs(first.pose.position.x);
  scene.grips.clear();
  for (int i = 0; i < c.hands; ++i) {
    Grip& grip = scene.grips.emplace_back(first);
    const double angle = 2.0 * std::numbers::pi * i / c.hands;
    grip.name = "hand " + std::to_string(i + 1);
    grip.pose.position = {radius * std::cos(angle), first.pose.position.y, radius * std::sin(angle)};
    grip.stiffness = c.stiffness;
    grip.damping = 0.03 * c.stiffness;
    grip.rotational_stiffness = 0.01 * c.stiffness;
    grip.rotational_damping = 0.0003 * c.stiffness;
  }
  return scene;
}

/// In as many sub-steps as its own step asks for.
Plan plan_of(const Scene& scene, double spacing, double time_step) {
  Plan plan = make_plan(scene, spacing);
  const double own = plan.time_step / plan.sub_steps;
  plan.time_step = time_step;
  plan.sub_steps = std::max(1, static_cast<int>(std::ceil(time_step / own - kHostRounding)));
  plan.max_speed = speed_limit(plan, time_step / plan.sub_steps);
  return plan;
}

}  // namespace

Result<std::shared_ptr<const Bucket>> load_bucket(double spacing) {
  const Result<std::filesystem::path> file = find_scene("bucket");
  if (!file) return file.error();
  Result<Scene> scene = load_scene(file.value());
  if (!scene) return scene.error();
  Result<SampledScene> sampled = sample_scene(scene.value(), spacing);
  if (!sampled) return sampled.error();
  return std::shared_ptr<const Bucket>(
      std::make_shared<Bucket>(Bucket{std::move(scene.value()), std::move(sampled.value()), spacing}));
}

ParticleHost::ParticleHost(const Case& c, double time_step)
    : scene_(held_by(c)),
      world_(scene_, c.bucket->sampled, plan_of(scene_, c.bucket->spacing, time_step),
             WorldOptions{1, Backend::kCpu}),
      models_(scene_),
      at_(static_cast<std::size_t>(scene_.grips[0].body)),
      wanted_(scene_.bodies.size(), 0) {
  wanted_[at_] = 1;
  const Grip& first = scene_.grips[0];
  gains_ = {first.stiffness, first.damping, first.rotational_stiffness, first.rotational_damping};
  const MassProperties& mass = scene_.bodies[at_].mass;
  body_ = {mass.mass, mass.inertia, {}, false, scene_.gravity};
  for (const Grip& grip : scene_.grips)
    grips_.push_back({grip.pose.position - mass.center_of_mass, grip.pose.orientation});
  on_hand_.resize(scene_.grips.size());
  world_.fill(now_);
  std::vector<HandleInput> hands;
  for (const GripState& grip : now_.grips) hands.push_back({grip.pose, Twist{}, true, 1.0});
  world_.settle(kSettles, hands);
  look();
}

void ParticleHost::look() {
  world_.fill(now_);
  const BodyState& body = now_.bodies[at_];
  motion_ = {body.center_of_mass, body.pose.orientation, body.twist};
  fluid_ = body.fluid;
  for (std::size_t i = 0; i < on_hand_.size(); ++i) on_hand_[i] = now_.grips[i].on_hand;
}

void ParticleHost::step(const std::vector<HandWord>& hands) {
  std::vector<HandleInput> inputs;
  for (const HandWord& hand : hands) inputs.push_back({hand.pose, hand.twist, hand.engaged, 1.0});
  const RigidMotion before = motion_;
  world_.step(inputs);
  look();
  const Wrench acting{fluid_.force + body_.mass * body_.gravity, fluid_.torque};
  given_ += glm::dot(acting.force, motion_.position - before.position) +
            glm::dot(acting.torque, rotation_between(before.orientation, motion_.orientation));
  models_.after_step(world_, now_, wanted_, said_);
  has_load_ = has_load_ || !said_.empty();
  if (said_.empty()) return;
  const FluidWrenchModel& model = said_.front();
  load_ = FluidLoad{};
  load_.d_pose = model.d_pose;
  load_.d_velocity = model.d_velocity;
  load_.added_mass = model.added_mass;
  load_.trust_distance = model.trust_radius;
  load_.trust_angle = model.trust_angle;
}

}  // namespace slosh::coupling
