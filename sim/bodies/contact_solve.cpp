// All contacts together.
#include <algorithm>
#include <array>

#include "sim/bodies/contacts.h"
#include "sim/bodies/joints.h"

namespace slosh {

namespace {

// Iterations of Gauss–Seidel, there and back: until no contact's speed changes by more than that (m/s; of
// what moves the poses alone and is not carried on, it may be more), or no impulse by more than rounding
// leaves of the largest, or the most that a step may cost. Flat faces that rub on each other come to that
// share hardly ever.
constexpr int kMaxIterations = 150;
constexpr double kVelocitySettled = 5e-7;
constexpr double kTravelSettled = 3e-5;
constexpr double kImpulseSettled = 1e-7;

/// Of a contact's normal and its two tangents, one a contact; empty without joints.
using Spreads = std::vector<std::array<JointSpread, 3>>;

/// Projected Gauss–Seidel with each iteration's steps made conjugate to the last one's (Silcowitz-Hansen
/// 2010). A stack of n bodies bends like a beam: alone, Gauss–Seidel takes some n⁴ iterations for that, with
/// this some n².
class Iteration {
 public:
  Iteration(const std::vector<Contact>& contacts, double rows::Targets::* target, Vector6 BodySolve::* speed,
            double settled, std::vector<rows::ContactRows>& all, std::vector<BodySolve>& solves,
            const Spreads& spreads, std::vector<AxisRow>* axes)
      : contacts_(contacts),
        target_(target),
        speed_(speed),
        settled_(settled),
        all_(all),
        solves_(solves),
        spreads_(spreads),
        axes_(axes ? *axes : no_axes_) {}

  /// `begin`: N·s on each contact's a.
  void run(const std::vector<glm::dvec3>& begin) {
    for (std::size_t i = 0; i < all_.size(); ++i) {
      rows::begin_with(all_[i], begin[i], a(i), b(i));
      spread(i, glm::dvec3(0.0));
    }
    for (AxisRow& axis : axes_) give(axis, axis.begin);
    std::vector<glm::dvec3> before(all_.size()), along(all_.size(), glm::dvec3(0.0));
    std::vector<double> axis_before(axes_.size()), axis_along(axes_.size(), 0.0);
    double last_square = 0.0;
    for (int turn = 1;; ++turn) {
      for (std::size_t i = 0; i < all_.size(); ++i) before[i] = impulse(i);
      for (std::size_t i = 0; i < axes_.size(); ++i) axis_before[i] = axes_[i].row.impulse;
      const bool settled = there_and_back();
      // The last is a whole iteration: what is made conjugate may pull.
      if (settled || turn == kMaxIterations) return;
      double square = 0.0;
      for (std::size_t i = 0; i < all_.size(); ++i) {
        before[i] = impulse(i) - before[i];
        square += glm::dot(before[i], before[i]);
      }
      for (std::size_t i = 0; i < axes_.size(); ++i) {
        axis_before[i] = axes_[i].row.impulse - axis_before[i];
        square += axis_before[i] * axis_before[i];
      }
      const double beta = last_square > 0.0 ? square / last_square : 0.0;
      last_square = square;
      for (std::size_t i = 0; i < all_.size(); ++i) {
        // Steps that grow have come upon a contact that opened or slipped: restart.
        const glm::dvec3 more = beta <= 1.0 ? beta * along[i] : glm::dvec3(0.0);
        const glm::dvec3 had = impulse(i);
        rows::apply(all_[i].normal, more.x, a(i), b(i));
        rows::apply(all_[i].tangent_u, more.y, a(i), b(i));
        rows::apply(all_[i].tangent_v, more.z, a(i), b(i));
        spread(i, had);
        along[i] = before[i] + more;
      }
      for (std::size_t i = 0; i < axes_.size(); ++i) {
        const double more = beta <= 1.0 ? beta * axis_along[i] : 0.0;
        give(axes_[i], more);
        axis_along[i] = axis_before[i] + more;
      }
    }
  }

 private:
  Vector6& a(std::size_t i) { return solves_[contacts_[i].a].*speed_; }
  Vector6& b(std::size_t i) { return solves_[contacts_[i].b].*speed_; }
  glm::dvec3 impulse(std::size_t i) const {
    return {all_[i].normal.impulse, all_[i].tangent_u.impulse, all_[i].tangent_v.impulse};
  }

  // What a contact's change of impulse since `had` does to bodies that hang on its two by joints.
  void spread(std::size_t i, const glm::dvec3& had) {
    if (spreads_.empty()) return;
    const glm::dvec3 change = impulse(i) - had;
    for (int row = 0; row < 3; ++row) spread(spreads_[i][row], change[row]);
  }
  void spread(const JointSpread& by, double change) {
    for (const auto& [body, response] : by.responses) {
      Vector6& twist = solves_[static_cast<std::size_t>(body)].*speed_;
      for (int c = 0; c < 6; ++c) twist[c] += change * response[c];
    }
  }

  Vector6& twist_of(int body) { return body < 0 ? world_ : solves_[static_cast<std::size_t>(body)].*speed_; }
  void give(AxisRow& axis, double impulse) {
    rows::apply(axis.row, impulse, twist_of(axis.a), twist_of(axis.b));
    spread(axis.spread, impulse);
  }
  // One motor or stop; returns the change of its impulse.
  double solve(AxisRow& axis) {
    const double speed = rows::speed_along(axis.row, twist_of(axis.a), twist_of(axis.b));
    const double wanted = axis.row.impulse + axis.row.effective_mass * (axis.target.*target_ - speed);
    const double change = std::clamp(wanted, axis.least, axis.most) - axis.row.impulse;
    give(axis, change);
    return std::abs(change);
  }

  // True where hardly anything changed.
  bool there_and_back() {
    double change = 0.0, largest = 0.0, axis_change = 0.0, axis_largest = 0.0, speed = 0.0;
    const auto solve_contact = [&](std::size_t i) {
      const glm::dvec3 had = impulse(i);
      const rows::Change now = rows::solve_once(all_[i], all_[i].target.*target_, a(i), b(i));
      change = std::max(change, now.impulse);
      speed = std::max(speed, now.speed);
      spread(i, had);
    };
    for (std::size_t i = 0; i < all_.size(); ++i) solve_contact(i);
    const auto solve_axis = [&](AxisRow& axis) {
      const double now = solve(axis);
      axis_change = std::max(axis_change, now);
      if (now > 0.0) speed = std::max(speed, now / axis.row.effective_mass);
    };
    for (AxisRow& axis : axes_) solve_axis(axis);
    for (std::size_t i = axes_.size(); i-- > 0;) solve_axis(axes_[i]);
    for (std::size_t i = all_.size(); i-- > 0;) solve_contact(i);
    for (const rows::ContactRows& rows : all_) largest = std::max(largest, rows.normal.impulse);
    for (const AxisRow& axis : axes_) axis_largest = std::max(axis_largest, std::abs(axis.row.impulse));
    return speed <= settled_ ||
           (change <= kImpulseSettled * largest && axis_change <= kImpulseSettled * axis_largest);
  }

  const std::vector<Contact>& contacts_;
  double rows::Targets::* target_;
  Vector6 BodySolve::* speed_;
  double settled_;
  std::vector<rows::ContactRows>& all_;
  std::vector<BodySolve>& solves_;
  const Spreads& spreads_;
  std::vector<AxisRow> no_axes_;
  std::vector<AxisRow>& axes_;
  Vector6 world_{};  // stands still
};

bool same_pair(const Contact& a, const Contact& b) {
  return std::minmax(a.a, a.b) == std::minmax(b.a, b.b);
}

}  // namespace

void solve_contacts(const std::vector<Contact>& contacts, const std::vector<ContactMaterial>& materials,
                    const std::vector<RigidBody>& bodies, double dt, ContactMemory& memory,
                    std::vector<BodySolve>& solves, JointSystem* joints) {
  std::vector<rows::ContactRows> all;
  std::vector<glm::dvec3> begin;
  all.reserve(contacts.size());
  begin.reserve(contacts.size());
  std::size_t first = 0, last = 0;  // of the pair's
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& c = contacts[i];
    if (i == last) {
      const auto other = std::find_if(contacts.begin() + static_cast<std::ptrdiff_t>(i), contacts.end(),
                                      [&](const Contact& next) { return !same_pair(next, c); });
      first = i;
      last = static_cast<std::size_t>(other - contacts.begin());
    }
    const ContactMaterial& a = materials[c.a];
    const ContactMaterial& b = materials[c.b];
    const ContactMaterial material{std::min(a.friction, b.friction), std::max(a.restitution, b.restitution)};
    all.push_back(
        rows::make_rows(c, c.of_blade ? ContactMaterial{} : material, bodies.data(), dt, solves.data()));
    // Several of a blade's are at one point.
    begin.push_back(c.of_blade ? memory.recall(c, i - first, last - first, bodies)
                               : memory.recall(c, bodies));
  }
  Spreads spreads(joints ? contacts.size() : 0);
  for (std::size_t i = 0; i < spreads.size(); ++i) {
    const Contact& c = contacts[i];
    for (int row = 0; row < 3; ++row) {
      const std::array constraints{&all[i].normal, &all[i].tangent_u, &all[i].tangent_v};
      joints->keep_joints(c.a, c.b, *constraints[row], spreads[i][row]);
    }
  }
  std::vector<AxisRow>* const axes = joints ? &joints->axis_rows() : nullptr;
  // What leaves the step and what moves the poses differ only where bodies overlap or bounce: overlap is
  // undone without leaving a velocity, and a bounce begins where it happens within the step.
  const auto as_is = [](const auto& r) { return r.target.velocity == r.target.travel; };
  const bool same =
      std::all_of(all.begin(), all.end(), as_is) && (!axes || std::all_of(axes->begin(), axes->end(), as_is));
  std::vector<rows::ContactRows> travelling;
  std::vector<AxisRow> travelling_axes;
  if (!same) {
    travelling = all;
    if (axes) travelling_axes = *axes;
  }
  Iteration(contacts, &rows::Targets::velocity, &BodySolve::velocity, kVelocitySettled, all, solves, spreads,
            axes)
      .run(begin);
  if (!same) {
    for (std::size_t i = 0; i < all.size(); ++i) begin[i] = rows::impulse_on_a(all[i]);
    for (std::size_t i = 0; i < travelling_axes.size(); ++i)
      travelling_axes[i].begin = (*axes)[i].row.impulse;
    Iteration(contacts, &rows::Targets::travel, &BodySolve::travel, kTravelSettled, travelling, solves,
              spreads, &travelling_axes)
        .run(begin);
  }
  for (std::size_t i = 0; i < spreads.size(); ++i) {
    const std::array impulses{all[i].normal.impulse, all[i].tangent_u.impulse, all[i].tangent_v.impulse};
    for (int row = 0; row < 3; ++row) joints->count(spreads[i][row], impulses[row]);
  }
  if (same) {
    for (BodySolve& solve : solves) solve.travel = solve.velocity;
  }
  memory.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i)
    memory.add(contacts[i], rows::impulse_on_a(all[i]), bodies);
}

}  // namespace slosh
