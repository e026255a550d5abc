// All contacts together.
#include <algorithm>

#include "sim/bodies/contacts.h"

namespace slosh {

namespace {

// Iterations of Gauss–Seidel, there and back: until no impulse changes by more than a share of the largest,
// or the most that a step may cost.
constexpr int kMaxIterations = 150;
constexpr double kSettled = 1e-7;

/// Projected Gauss–Seidel with each iteration's steps made conjugate to the last one's (Silcowitz-Hansen
/// 2010). A stack of n bodies bends like a beam: alone, Gauss–Seidel takes some n⁴ iterations for that, with
/// this some n².
class Iteration {
 public:
  Iteration(const std::vector<Contact>& contacts, double rows::Targets::* target, Vector6 BodySolve::* speed,
            std::vector<rows::ContactRows>& all, std::vector<BodySolve>& solves)
      : contacts_(contacts), target_(target), speed_(speed), all_(all), solves_(solves) {}

  /// `begin`: N·s on each contact's a.
  void run(const std::vector<glm::dvec3>& begin) {
    for (std::size_t i = 0; i < all_.size(); ++i) rows::begin_with(all_[i], begin[i], a(i), b(i));
    std::vector<glm::dvec3> before(all_.size()), along(all_.size(), glm::dvec3(0.0));
    double last_square = 0.0;
    for (int turn = 1;; ++turn) {
      for (std::size_t i = 0; i < all_.size(); ++i) before[i] = impulse(i);
      const bool settled = there_and_back();
      // The last is a whole iteration: what is made conjugate may pull.
      if (settled || turn == kMaxIterations) return;
      double square = 0.0;
      for (std::size_t i = 0; i < all_.size(); ++i) {
        before[i] = impulse(i) - before[i];
        square += glm::dot(before[i], before[i]);
      }
      const double beta = last_square > 0.0 ? square / last_square : 0.0;
      last_square = square;
      for (std::size_t i = 0; i < all_.size(); ++i) {
        // Steps that grow have come upon a contact that opened or slipped: restart.
        const glm::dvec3 more = beta <= 1.0 ? beta * along[i] : glm::dvec3(0.0);
        rows::apply(all_[i].normal, more.x, a(i), b(i));
        rows::apply(all_[i].tangent_u, more.y, a(i), b(i));
        rows::apply(all_[i].tangent_v, more.z, a(i), b(i));
        along[i] = before[i] + more;
      }
    }
  }

 private:
  Vector6& a(std::size_t i) { return solves_[contacts_[i].a].*speed_; }
  Vector6& b(std::size_t i) { return solves_[contacts_[i].b].*speed_; }
  glm::dvec3 impulse(std::size_t i) const {
    return {all_[i].normal.impulse, all_[i].tangent_u.impulse, all_[i].tangent_v.impulse};
  }

  // True where hardly an impulse changed.
  bool there_and_back() {
    double change = 0.0, largest = 0.0;
    const auto solve = [&](std::size_t i) {
      change = std::max(change, rows::solve_once(all_[i], all_[i].target.*target_, a(i), b(i)));
    };
    for (std::size_t i = 0; i < all_.size(); ++i) solve(i);
    for (std::size_t i = all_.size(); i-- > 0;) solve(i);
    for (const rows::ContactRows& rows : all_) largest = std::max(largest, rows.normal.impulse);
    return change <= kSettled * largest;
  }

  const std::vector<Contact>& contacts_;
  double rows::Targets::* target_;
  Vector6 BodySolve::* speed_;
  std::vector<rows::ContactRows>& all_;
  std::vector<BodySolve>& solves_;
};

}  // namespace

void solve_contacts(const std::vector<Contact>& contacts, const std::vector<ContactMaterial>& materials,
                    const std::vector<RigidBody>& bodies, double dt, ContactMemory& memory,
                    std::vector<BodySolve>& solves) {
  std::vector<rows::ContactRows> all;
  std::vector<glm::dvec3> begin;
  all.reserve(contacts.size());
  begin.reserve(contacts.size());
  for (const Contact& c : contacts) {
    const ContactMaterial& a = materials[c.a];
    const ContactMaterial& b = materials[c.b];
    const ContactMaterial material{std::min(a.friction, b.friction), std::max(a.restitution, b.restitution)};
    all.push_back(rows::make_rows(c, material, bodies.data(), dt, solves.data()));
    begin.push_back(memory.recall(c, bodies));
  }
  // What leaves the step and what moves the poses differ only where bodies overlap or bounce: overlap is
  // undone without leaving a velocity, and a bounce begins where it happens within the step.
  const bool same =
      std::all_of(all.begin(), all.end(), [](const auto& r) { return r.target.velocity == r.target.travel; });
  if (!same) {
    std::vector<rows::ContactRows> travelling = all;
    Iteration(contacts, &rows::Targets::travel, &BodySolve::travel, travelling, solves).run(begin);
  }
  Iteration(contacts, &rows::Targets::velocity, &BodySolve::velocity, all, solves).run(begin);
  if (same) {
    for (BodySolve& solve : solves) solve.travel = solve.velocity;
  }
  memory.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i)
    memory.add(contacts[i], rows::impulse_on_a(all[i]), bodies);
}

}  // namespace slosh
