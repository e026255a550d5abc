#include "tests/lab/coupling/virtual_host.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slosh::coupling {
namespace {

constexpr double kRadius = 0.15;         // m
constexpr double kFluidMass = 1.5;       // kg
constexpr double kSwing = 1.5;           // Hz
constexpr double kFluidDamping = 1.0;    // N·s/m, of the swing
constexpr double kDrag = 4.0;            // N·s/m
constexpr double kTurningDrag = 0.02;    // N·m·s/rad
constexpr double kSyrupDrag = 40.0;      // N·s/m
constexpr double kSyrupTurning = 0.1;    // N·m·s/rad
constexpr double kGravity = 9.81;        // m/s²
constexpr double kTable = 2e4;           // N/m
constexpr double kTableDamping = 100.0;  // N·s/m

}  // namespace

VirtualHost::VirtualHost(const Case& c, double time_step) : kind_(c.load), dt_(time_step) {
  gains_ = {c.stiffness, 0.03 * c.stiffness, 0.01 * c.stiffness, 0.0003 * c.stiffness};
  on_hand_.resize(static_cast<std::size_t>(c.hands));
  has_load_ = kind_ == Load::kFluid || kind_ == Load::kSyrup || kind_ == Load::kCarried;
  rigid_.free = true;
  rigid_.mass = c.body_mass;
  rigid_.inertia = glm::dmat3(0.0);
  rigid_.inertia[0][0] = rigid_.inertia[2][2] = 0.03;
  rigid_.inertia[1][1] = 0.025;
  rigid_.inverse_inertia = glm::inverse(rigid_.inertia);
  for (int i = 0; i < c.hands; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / c.hands;
    Pose& grip = grips_.emplace_back();
    grip.position = {kRadius * std::cos(angle), 0.05, kRadius * std::sin(angle)};
  }
  body_.mass = rigid_.mass;
  body_.inertia = rigid_.inertia;
}

/// The fluid in the body: a mass on a spring, and drag. Or its weight, and the table's spring.
Wrench VirtualHost::external() {
  if (kind_ == Load::kNone) return {};
  if (kind_ == Load::kTable) {
    const double in = std::max(-rigid_.position.y, 0.0);
    const double pushes = in > 0.0 ? kTable * in - kTableDamping * rigid_.velocity.y : 0.0;
    return {{0.0, std::max(pushes, 0.0) - rigid_.mass * kGravity, 0.0}, {}};
  }
  if (kind_ == Load::kSyrup || kind_ == Load::kSyrupUntold)
    return fluid_ = {-kSyrupDrag * rigid_.velocity, -kSyrupTurning * rigid_.angular_velocity};
  const double pace = 2.0 * std::numbers::pi * kSwing;
  const glm::dvec3 pull = kFluidMass * pace * pace * (fluid_place_ - rigid_.position) +
                          kFluidDamping * (fluid_velocity_ - rigid_.velocity);
  fluid_velocity_ -= dt_ / kFluidMass * pull;
  fluid_place_ += dt_ * fluid_velocity_;
  const glm::dvec3 gravity(0.0, kind_ == Load::kCarried ? -kGravity : 0.0, 0.0);
  fluid_ = {pull + kFluidMass * gravity - kDrag * rigid_.velocity, -kTurningDrag * rigid_.angular_velocity};
  return {fluid_.force + rigid_.mass * gravity, fluid_.torque};
}

void VirtualHost::step(const std::vector<HandWord>& hands) {
  std::vector<ActiveCoupling> couplings;
  for (std::size_t i = 0; i < hands.size(); ++i) {
    on_hand_[i] = Wrench{};
    if (!hands[i].engaged) continue;
    ActiveCoupling& c = couplings.emplace_back();
    c.grip = static_cast<int>(i);
    c.gains = gains_;
    c.handle = hands[i].pose;
    c.handle_twist = hands[i].twist;
    c.grip_pose = compose(rigid_.mesh_pose(), grips_[i]);
    c.arm = c.grip_pose.position - rigid_.position;
  }
  const Wrench acting = external();
  const glm::dvec3 before = rigid_.velocity, place = rigid_.position;
  const glm::dquat axes = rigid_.orientation;
  BodySolve solve;
  if (!solve_body(rigid_, acting, couplings, dt_, solve)) return;
  advance_body(rigid_, solve, dt_);
  given_ += glm::dot(acting.force, rigid_.position - place) +
            glm::dot(acting.torque, rotation_between(axes, rigid_.orientation));
  motion_ = {rigid_.position, rigid_.orientation, {rigid_.velocity, rigid_.angular_velocity}};
  for (const ActiveCoupling& c : couplings) {
    const Wrench on_body = coupling_wrench(c, solve, dt_);
    on_hand_[static_cast<std::size_t>(c.grip)] = {-on_body.force, -on_body.torque};
  }
  if (has_load_) note_load(acting, rigid_.velocity - before);
}

/// As a host says it: what is left of the force without what it gave for being accelerated.
void VirtualHost::note_load(const Wrench& acting, const glm::dvec3& gained) {
  const bool syrup = kind_ == Load::kSyrup;
  const double added = syrup ? 0.0 : kFluidMass;
  const glm::dvec3 left = acting.force + added * gained / dt_;
  load_.reference = {rigid_.position, rigid_.orientation};
  load_.twist = {rigid_.velocity, rigid_.angular_velocity};
  load_.wrench = {left.x, left.y, left.z, acting.torque.x, acting.torque.y, acting.torque.z};
  for (std::size_t i = 0; i < 3; ++i) {
    load_.added_mass[i][i] = added;
    load_.d_velocity[i][i] = syrup ? -kSyrupDrag : -kDrag;
    load_.d_velocity[3 + i][3 + i] = syrup ? -kSyrupTurning : -kTurningDrag;
  }
}

}  // namespace slosh::coupling
