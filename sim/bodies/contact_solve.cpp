// All contacts together, by projected Gauss–Seidel.
#include <algorithm>

#include "sim/bodies/contacts.h"

namespace slosh {

namespace {

// Turns of Gauss–Seidel: until no impulse changes by more than a share of the largest, or the most that a
// step may cost. A weight passes through a stack of n bodies in some n² turns.
constexpr int kMostIterations = 300;
constexpr double kSettled = 1e-7;

void iterate(const std::vector<Contact>& contacts, std::vector<rows::ContactRows>& all,
             double rows::Targets::*target, Vector6 BodySolve::*speed, std::vector<BodySolve>& solves) {
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    double change = 0.0;
    double largest = 0.0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      change = std::max(change, rows::solve_once(all[i], all[i].target.*target, solves[contacts[i].a].*speed,
                                                 solves[contacts[i].b].*speed));
      largest = std::max(largest, all[i].normal.impulse);
    }
    if (change <= kSettled * largest) return;
  }
}

}  // namespace

void solve_contacts(const std::vector<Contact>& contacts, const std::vector<ContactMaterial>& materials,
                    const std::vector<RigidBody>& bodies, double dt, std::vector<BodySolve>& solves) {
  std::vector<rows::ContactRows> all;
  all.reserve(contacts.size());
  for (const Contact& c : contacts) {
    const ContactMaterial& a = materials[c.a];
    const ContactMaterial& b = materials[c.b];
    const ContactMaterial material{std::min(a.friction, b.friction), std::max(a.restitution, b.restitution)};
    all.push_back(rows::make_rows(c, material, bodies.data(), dt, solves.data()));
  }
  // What leaves the step and what moves the poses differ only where bodies overlap or bounce: overlap is
  // undone without leaving a velocity, and a bounce begins where it happens within the step.
  const bool same =
      std::all_of(all.begin(), all.end(), [](const auto& r) { return r.target.velocity == r.target.travel; });
  if (!same) {
    std::vector<rows::ContactRows> travelling = all;
    iterate(contacts, travelling, &rows::Targets::travel, &BodySolve::travel, solves);
  }
  iterate(contacts, all, &rows::Targets::velocity, &BodySolve::velocity, solves);
  if (same) {
    for (BodySolve& solve : solves) solve.travel = solve.velocity;
  }
}

}  // namespace slosh
