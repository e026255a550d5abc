// What cuts have left of the bodies, and the mass of a body.
#pragma once

#include <cmath>

#include "net/wire/messages.h"
#include "sim/math/body_cuts.h"

namespace slosh::wire {

constexpr double kMaxInertia = 1e18;  ///< kg·m²
constexpr double kMaxMass = 1e9;      ///< kg

/// Positive definite, as a solid's is.
inline bool can_turn(const glm::dmat3& inertia) {
  const double minor = inertia[0][0] * inertia[1][1] - inertia[0][1] * inertia[1][0];
  return inertia[0][0] > 0.0 && minor > 0.0 && glm::determinant(inertia) > 0.0;
}

template <class V>
void visit(V& v, MassProperties& m) {
  v.real64("mass", m.mass, 0.0, kMaxMass);
  v.vec3_exact("center_of_mass", m.center_of_mass, kMaxPosition);
  v.vec3_exact("inertia_x", m.inertia[0], kMaxInertia);
  v.vec3_exact("inertia_y", m.inertia[1], kMaxInertia);
  v.vec3_exact("inertia_z", m.inertia[2], kMaxInertia);
}

template <class V>
void visit(V& v, CutPlane& m) {
  v.vec3_exact("normal", m.normal, 1.0 + 1e-6);
  v.rule("normal", std::abs(glm::length(m.normal) - 1.0) < 1e-6, "is not of length 1");
  v.real64("offset", m.offset, -kMaxPosition, kMaxPosition);
}

/// A body of which cuts have left a part.
struct CutEntry {
  std::uint32_t body = 0;
  BodyCut cut;
};
template <class V>
void visit(V& v, CutEntry& m) {
  v.natural("body", m.body, 0, kMaxBodies - 1);
  v.list("planes", m.cut.planes, kMaxCutPlanes, [](auto& each, CutPlane& plane) { visit(each, plane); });
  visit(v, m.cut.mass);
  v.rule("mass", m.cut.mass.mass > 0.0, "is 0");
  v.rule("inertia_x", can_turn(m.cut.mass.inertia), "is not the inertia of a solid");
}

/// All bodies that are cut, from one tick on: after the first WorldInfo where there are any, and after each
/// cut. Behind kBodyCuts.
struct Cuts {
  static constexpr ControlType kType = ControlType::kCuts;
  std::uint32_t run = 0;
  std::uint64_t since = 0;  ///< tick of the first state that has them
  std::vector<CutEntry> bodies;
};
template <class V>
void visit(V& v, Cuts& m) {
  v.natural("run", m.run, 0, 0xffffffff);
  v.natural("since", m.since, 0, kMaxTick);
  v.list("bodies", m.bodies, kMaxBodies, [](auto& each, CutEntry& entry) { visit(each, entry); });
}

/// One a body of a scene into the message, and back. What the scene has not is left out.
Cuts to_message(const BodyCuts& cuts, std::uint32_t run);
BodyCuts to_cuts(const Cuts& message, std::size_t bodies);

}  // namespace slosh::wire
