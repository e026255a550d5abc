#include "peer/replica/body_replica.h"

#include <algorithm>
#include <cmath>

#include "peer/replica/vector6.h"

namespace slosh {
namespace {

constexpr std::size_t kRemembered = 2048;  // ticks: a host's answer may be 2 s late
constexpr double kNoStiffness = 1e-6;      // N/m, N·m/rad
constexpr double kSloshTaken = 0.03;       // s over which what swings is corrected
constexpr double kRootTwo = 1.4142135623730951;

using namespace vector6;

}  // namespace

BodyReplica::BodyReplica(const ReplicaBody& body, std::vector<ReplicaGrip> grips, const ReplicaTuning& tuning)
    : body_(body),
      grips_(std::move(grips)),
      tuning_(tuning),
      history_(kRemembered),
      ledgers_(grips_.size()) {}

void BodyReplica::restart(const RigidMotion& motion) noexcept {
  now_ = motion;
  pending_ = MotionError{};
  swings_ = swings_pending_ = {};
  pace_ = glm::dvec3(0.0);
  history_.forget();
  has_word_ = loaded_ = false;
  load_ = received_load_ = FluidLoad{};
  std::fill(ledgers_.begin(), ledgers_.end(), Ledger{});
  excess_ = work_ = work_received_ = slosh_work_ = slosh_received_ = stored_ = 0.0;
  started_ = true;
}

double BodyReplica::time_constant() const noexcept {
  return std::max(tuning_.least_time, tuning_.round_trips * delay_.round_trip);
}

void BodyReplica::receive(const HostMotion& host) noexcept {
  if (!started_) return restart(host.motion);
  if (host.ack_ns == 0) return;
  word_ = host;
  has_word_ = true;
}

/// The host's update may be of a moment that is still to come here, where the way to it is short.
void BodyReplica::compare(std::int64_t now_ns) noexcept {
  if (!has_word_ || word_.ack_ns > now_ns) return;
  has_word_ = false;
  RigidMotion then;
  double work = 0.0;
  if (!history_.at(word_.ack_ns, then, work, slosh_received_)) return;
  pending_ = difference(word_.motion, then);
  foresee_slosh(then.twist.linear);
  work_received_ = word_.work;
  work_ += word_.work - work;
  history_.correct_work(word_.work - work);
}

/// What swung at the host then swings on until now, moved as the body was here since.
void BodyReplica::foresee_slosh(glm::dvec3 velocity) noexcept {
  double mass = 0.0;
  for (const SloshMode& mode : load_.swings) mass += mode.mass;
  if (!(mass > 0.0)) return;
  std::array<SloshState, 3> then = word_.swings;
  std::int64_t stamp_ns = word_.ack_ns;
  double steps_for = 0.0;
  std::array<SloshStep, 3> steps;
  history_.since(word_.ack_ns, [&](std::int64_t to_ns, const RigidMotion& motion) {
    const double dt = 1e-9 * static_cast<double>(to_ns - stamp_ns);
    if (std::abs(dt - steps_for) > 1e-6) {
      steps_for = dt;
      for (int i = 0; i < 3; ++i) {
        const auto axis = static_cast<std::size_t>(i);
        steps[axis] = SloshStep(load_.swings[axis].pace, load_.swings[axis].damping, dt);
      }
    }
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      then[axis] = steps[axis](then[axis], motion.twist.linear[i] - velocity[i]);
    }
    velocity = motion.twist.linear;
    stamp_ns = to_ns;
  });
  for (std::size_t i = 0; i < 3; ++i)
    swings_pending_[i] = {then[i].place - swings_[i].place, then[i].speed - swings_[i].speed};
}

/// `change`: of the body's velocity in this step, without what was corrected of it.
void BodyReplica::swing(const glm::dvec3& change, double dt) noexcept {
  const double share = 1.0 - std::exp(-dt / kSloshTaken);
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const SloshMode& mode = load_.swings[axis];
    SloshState& s = swings_[axis];
    SloshState& pending = swings_pending_[axis];
    s = SloshStep(mode.pace, mode.damping, dt)(s, change[i]);
    // A body that is accelerated upwards makes it the heavier.
    s.speed += mode.pace * mode.pace * s.place * glm::dot(load_.bowl, change);
    s.place += share * pending.place;
    s.speed += share * pending.speed;
    pending.place *= 1.0 - share;
    pending.speed *= 1.0 - share;
  }
}

void BodyReplica::set_load(const FluidLoad& load) noexcept {
  received_load_ = made_safe(load);
  if (!loaded_) load_ = received_load_;
  loaded_ = true;
}

/// What the fluid did a round trip ago answers to what the body did then: fed back at once it would drive a
/// swing of the fluid that is about as slow.
void BodyReplica::follow_load(double dt) noexcept {
  const double time = tuning_.load_round_trips * (delay_.round_trip + delay_.jitter);
  const double share = time > dt ? 1.0 - std::exp(-dt / time) : 1.0;
  // As what is foreseen is by the newest masses, so is the body.
  const double foreseen = share + received_load_.foreseen * (1.0 - share);
  const double goes_on = 1.0 - std::exp(-dt / kGoesOnTaken);
  for_each_load_field([&](const auto& row) {
    auto& at = load_.*row.field;
    const auto& to = received_load_.*row.field;
    switch (row.taken) {
      case LoadField::kAtOnce:
        at = to;
        break;
      case LoadField::kLate:
        ease(at, to, share);
        break;
      case LoadField::kForeseen:
        ease(at, to, foreseen);
        break;
      case LoadField::kGoesOn:
        ease(at, to, goes_on);
        break;
    }
  });
}

GripState BodyReplica::grip(std::size_t g) const noexcept {
  GripState state;
  const glm::dvec3 arm = now_.orientation * (grips_[g].pose.position - body_.center);
  state.pose = {now_.position + arm, now_.orientation * grips_[g].pose.orientation};
  state.twist = {now_.twist.linear + glm::cross(now_.twist.angular, arm), now_.twist.angular};
  return state;
}

double BodyReplica::damping(std::size_t g) const noexcept {
  return 0.5 * grips_[g].gains.stiffness * (0.5 * delay_.round_trip + delay_.jitter) / kRootTwo;
}

double BodyReplica::rotational_damping(std::size_t g) const noexcept {
  return 0.5 * grips_[g].gains.rotational_stiffness * (0.5 * delay_.round_trip + delay_.jitter) / kRootTwo;
}

Matrix6 BodyReplica::mass_matrix() const noexcept {
  Matrix6 m{};
  const glm::dmat3 inertia = turned(body_.inertia, now_.orientation);
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    m[row][row] = body_.mass;
    for (int j = 0; j < 3; ++j) m[3 + row][3 + static_cast<std::size_t>(j)] = inertia[j][i];
  }
  add(m, symmetric_part(load_.added_mass, 1.0), 1.0);
  return m;
}

/// The couplings' own pace ω₀ against the delay: at a body that answers faster than updates of others come,
/// they pull less.
void BodyReplica::soften(const std::vector<ReplicaHand>& hands) noexcept {
  double stiffness = 0.0, turning = 0.0, others = 0.0;
  for (std::size_t g = 0; g < grips_.size() && g < hands.size(); ++g) {
    if (!hands[g].engaged) continue;
    const CouplingGains& k = grips_[g].gains;
    const glm::dvec3 arm = grips_[g].pose.position - body_.center;
    stiffness += k.stiffness;
    turning += k.rotational_stiffness + k.stiffness * glm::dot(arm, arm);
    if (!hands[g].own) others += k.stiffness;
  }
  const Matrix6 mass = mass_matrix();
  const double lightest = std::min({mass[0][0], mass[1][1], mass[2][2]});
  const double slightest = std::min({mass[3][3], mass[4][4], mass[5][5]});
  const double late = tuning_.softening * (delay_.round_trip + delay_.jitter);
  const auto soft = [&](double k, double m) { return 1.0 / (1.0 + late * late * k / m); };
  soft_ = soft(stiffness, lightest);
  rotational_soft_ = body_.point ? soft_ : soft(turning, slightest);
  shared_ = stiffness > 0.0 ? others / stiffness : 0.0;
}

/// A load rests on all couplings of the body, at the host; here those of other sites are soft, and their part
/// of it with them: so much of it is left that it bends these couplings as far as the load bends those.
void BodyReplica::share_out(const std::vector<ReplicaHand>& hands, Vector6& load) const noexcept {
  Matrix6 full{}, soft{};
  bool others = false;
  for (std::size_t g = 0; g < grips_.size() && g < hands.size(); ++g) {
    if (!hands[g].engaged) continue;
    others = others || !hands[g].own;
    const CouplingGains& k = grips_[g].gains;
    const glm::dvec3 arm =
        body_.point ? glm::dvec3(0.0) : now_.orientation * (grips_[g].pose.position - body_.center);
    add_gain(full, k.stiffness, arm);
    add_gain(soft, (hands[g].own ? 1.0 : soft_) * k.stiffness, arm);
    for (std::size_t i = 3; i < 6; ++i) {
      full[i][i] += k.rotational_stiffness;
      soft[i][i] += (hands[g].own ? 1.0 : rotational_soft_) * k.rotational_stiffness;
    }
  }
  if (!others) return;
  // What no coupling holds is not shared out.
  for (std::size_t i = 0; i < 6; ++i) {
    full[i][i] += kNoStiffness;
    soft[i][i] += kNoStiffness;
  }
  Matrix6 factor;
  if (cholesky(full, factor)) load = product(soft, cholesky_solve(factor, load));
}

/// What the hands of other sites gave in this step, against what their persons put in; the excess is taken
/// out of the motion.
void BodyReplica::settle(const std::vector<ReplicaHand>& hands, double dt) noexcept {
  excess_ = 0.0;
  double worst = 0.0;
  Ledger* debtor = nullptr;
  for (std::size_t g = 0; g < grips_.size() && g < hands.size(); ++g) {
    const ReplicaHand& hand = hands[g];
    Ledger& ledger = ledgers_[g];
    if (!hand.engaged || hand.own) {
      ledger = Ledger{};
      continue;
    }
    if (!ledger.open) ledger = {0.0, hand.energy, true};
    const GripState at = grip(g);
    const CouplingGains& k = grips_[g].gains;
    const Wrench pull = coupling_wrench_on_hand(k, hand.handle, hand.twist, at.pose, at.twist);
    const double power = -soft_ * glm::dot(pull.force, hand.twist.linear) -
                         rotational_soft_ * glm::dot(pull.torque, hand.twist.angular);
    ledger.given += dt * power;
    const double over = ledger.given - (hand.energy - ledger.base);
    if (over > worst) {
      worst = over;
      debtor = &ledger;
    }
  }
  const double untrusted = (1.0 - load_trust_) * (work_ - work_received_ - slosh_since());
  if (untrusted > worst) {
    work_ -= take(untrusted);
    return;
  }
  if (debtor == nullptr) return;
  const double taken = take(worst);
  debtor->given -= taken;
  excess_ = worst - taken;
}

/// Takes `energy` J, but no more than a share of the kinetic energy, out of the motion; returns what was
/// taken.
double BodyReplica::take(double energy) noexcept {
  const Vector6 v = six(now_.twist.linear, now_.twist.angular);
  const Vector6 p = product(mass_matrix(), v);
  double kinetic = 0.0;
  for (std::size_t i = 0; i < 6; ++i) kinetic += 0.5 * v[i] * p[i];
  if (!(kinetic > 0.0)) return 0.0;
  const double taken = std::min(energy, tuning_.most_taken * kinetic);
  const double keep = std::sqrt(1.0 - taken / kinetic);
  now_.twist.linear *= keep;
  now_.twist.angular *= keep;
  return taken;
}

void BodyReplica::advance(const std::vector<ReplicaHand>& hands, double dt, std::int64_t now_ns,
                          double trust) noexcept {
  if (!started_ || !(dt > 0.0)) return;
  follow_load(dt);
  soften(hands);
  Matrix6 matrix = mass_matrix();
  const Vector6 v = six(now_.twist.linear, now_.twist.angular);
  Vector6 rhs = product(matrix, v);
  const glm::dmat3 inertia = turned(body_.inertia, now_.orientation);
  const glm::dvec3 gyroscopic = -glm::cross(now_.twist.angular, inertia * now_.twist.angular);
  add(rhs, six(glm::dvec3(0.0), gyroscopic), dt);

  // The fluid. Beyond the trusted distance its springs pull as there.
  const glm::dvec3 off = clipped(now_.position - load_.reference.position, load_.trust_distance);
  const glm::dvec3 turn =
      clipped(rotation_between(load_.reference.orientation, now_.orientation), load_.trust_angle);
  Vector6 fluid = load_.wrench;
  for (std::size_t i = 0; i < 3; ++i)
    fluid[i] += load_.foreseen * (load_.goes_on[static_cast<int>(i)] - load_.late[static_cast<int>(i)]);
  add(fluid, product(load_.d_pose, six(off, turn)));
  add(fluid, product(load_.d_velocity, six(load_.twist.linear, load_.twist.angular)), -1.0);
  Vector6 slosh{};
  for (std::size_t i = 0; i < 3; ++i) slosh[i] = slosh_force(load_.swings[i], swings_[i]);
  for (std::size_t i = 0; i < 3; ++i) {
    const double rises = bowl_force(load_.swings[i], swings_[i], pace_[static_cast<int>(i)]);
    for (std::size_t j = 0; j < 3; ++j) slosh[j] += load_.bowl[static_cast<int>(j)] * rises;
  }
  add(fluid, slosh);
  Vector6 acting = fluid;  // whole, as its work is: everybody's energy is counted
  share_out(hands, fluid);
  add(rhs, fluid, dt * trust);
  // Its damper: what is symmetric of it implicitly, the rest (which does no work) with the velocity of now.
  const Matrix6 damper = symmetric_part(load_.d_velocity, -1.0);
  Matrix6 swirl = load_.d_velocity;
  add(swirl, damper, 1.0);
  add(rhs, product(swirl, v), dt * trust);
  add(matrix, damper, dt * trust);

  for (std::size_t g = 0; g < grips_.size() && g < hands.size(); ++g) {
    const ReplicaHand& hand = hands[g];
    if (!hand.engaged) continue;
    const CouplingGains& k = grips_[g].gains;
    const double s = hand.own ? 1.0 : soft_;
    const double r = hand.own ? 1.0 : rotational_soft_;
    const GripState at = grip(g);
    const glm::dvec3 arm = body_.point ? glm::dvec3(0.0) : at.pose.position - now_.position;
    const double gain = s * (k.damping + k.stiffness * dt);
    const double turning = r * (k.rotational_damping + k.rotational_stiffness * dt);
    const glm::dvec3 force =
        s * k.stiffness * (hand.handle.position - at.pose.position) + gain * hand.twist.linear;
    const glm::dvec3 torque =
        r * k.rotational_stiffness * rotation_between(at.pose.orientation, hand.handle.orientation) +
        turning * hand.twist.angular;
    add(rhs, six(force, glm::cross(arm, force) + torque), dt);
    add_gain(matrix, dt * gain, arm);
    for (std::size_t i = 3; i < 6; ++i) matrix[i][i] += dt * turning;
  }
  Matrix6 factor;
  if (!cholesky(matrix, factor)) return;
  const Vector6 next = cholesky_solve(factor, rhs);
  double sum = 0.0;
  for (const double each : next) sum += each;
  if (!std::isfinite(sum)) return;
  Vector6 middle = v;
  add(middle, next);
  add(acting, product(load_.d_velocity, next));
  for (std::size_t i = 0; i < 6; ++i) {
    work_ += 0.5 * dt * trust * acting[i] * middle[i];
    slosh_work_ += 0.5 * dt * trust * slosh[i] * middle[i];
  }
  swing(linear(next) - now_.twist.linear, dt);
  pace_ = (linear(next) - now_.twist.linear) / dt;
  now_.twist = {linear(next), body_.point ? glm::dvec3(0.0) : angular(next)};
  now_.position += dt * now_.twist.linear;
  now_.orientation = rotate_by(now_.orientation, dt * now_.twist.angular);

  history_.note(now_ns, now_, work_, slosh_work_);
  compare(now_ns);
  const double share = 1.0 - std::exp(-dt / time_constant());
  const MotionError by = scaled(pending_, share);
  pending_ = scaled(pending_, 1.0 - share);
  // What the load does over the way that a correction takes counts as well: a weight that the host has lower
  // is lower.
  const Vector6 way = six(by.position, by.turn);
  for (std::size_t i = 0; i < 6; ++i) {
    work_ += trust * acting[i] * way[i];
    slosh_work_ += trust * slosh[i] * way[i];
  }
  now_ = moved(now_, by);
  history_.correct(by);
  settle(hands, dt);
  sum_up(hands);
}

void BodyReplica::sum_up(const std::vector<ReplicaHand>& hands) noexcept {
  const Vector6 v = six(now_.twist.linear, now_.twist.angular);
  const Vector6 p = product(mass_matrix(), v);
  stored_ = 0.0;
  for (std::size_t i = 0; i < 6; ++i) stored_ += 0.5 * v[i] * p[i];
  for (std::size_t g = 0; g < grips_.size() && g < hands.size(); ++g) {
    const ReplicaHand& hand = hands[g];
    if (!hand.engaged) continue;
    const GripState at = grip(g);
    const glm::dvec3 off = hand.handle.position - at.pose.position;
    const glm::dvec3 turn = rotation_between(at.pose.orientation, hand.handle.orientation);
    const CouplingGains& k = grips_[g].gains;
    stored_ += 0.5 * (hand.own ? 1.0 : soft_) * k.stiffness * glm::dot(off, off) +
               0.5 * (hand.own ? 1.0 : rotational_soft_) * k.rotational_stiffness * glm::dot(turn, turn);
  }
}

}  // namespace slosh
