// What the penetration clamp took from particles, summed so that the order does not matter.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "sim/math/host_device.h"
#include "sim/math/pose.h"

namespace slosh {

/// The units in which impulses are counted: whole numbers add up to the same in every order.
struct ImpulseUnits {
  double linear = 0.0;   ///< kg·m/s
  double angular = 0.0;  ///< kg·m²/s
};

/// Units for particles of at most `mass` kg at about `speed` m/s in scenes some hundred times `spacing` m
/// wide: 2³⁶ for one at full speed, so that 2²⁵ of them fit.
inline ImpulseUnits impulse_units(double mass, double speed, double spacing) {
  const double linear = std::ldexp(mass * speed, -36);
  return {linear, 256.0 * spacing * linear};
}

/// Words a body in the sums: three of its impulse, three of its angular impulse about its centre of mass. One
/// more word behind those of all bodies counts the particles.
inline constexpr std::size_t kImpulseWords = 6;

/// How often particles were put back, and what bodies have not been given of it yet.
using ImpulseSums = std::vector<std::int64_t>;
inline ImpulseSums no_impulses(std::size_t bodies) {
  return ImpulseSums(kImpulseWords * bodies + 1, 0);
}

/// A particle before and after it was put back.
struct PutBack {
  float mass;               ///< kg
  glm::vec3 from, to;       ///< m, world
  glm::vec3 before, after;  ///< m/s
};

SLOSH_HD inline std::int64_t in_units(double value, double unit) {
  constexpr double kMax = 1e15;
  const double count = value / unit;
  return static_cast<std::int64_t>(std::floor(0.5 + (count > kMax ? kMax : count < -kMax ? -kMax : count)));
}

/// Calls add(word, value) for each of the body's six words: all that the particle lost in momentum, and in
/// angular momentum about `center` (m, world), the move itself included.
template <class Add>
SLOSH_HD inline void impulse_on_body(const PutBack& p, const glm::dvec3& center, const ImpulseUnits& units,
                                     Add&& add) {
  const glm::dvec3 before = static_cast<double>(p.mass) * glm::dvec3(p.before);
  const glm::dvec3 after = static_cast<double>(p.mass) * glm::dvec3(p.after);
  const glm::dvec3 lost = before - after;
  const glm::dvec3 turned =
      glm::cross(glm::dvec3(p.from) - center, before) - glm::cross(glm::dvec3(p.to) - center, after);
  for (int i = 0; i < 3; ++i) {
    add(i, in_units(lost[i], units.linear));
    add(3 + i, in_units(turned[i], units.angular));
  }
}

/// About a centre from which the one before is `off` m away.
inline void recentre(std::span<std::int64_t> words, const glm::dvec3& off, const ImpulseUnits& units) {
  glm::dvec3 impulse(0.0);
  for (int i = 0; i < 3; ++i) impulse[i] = static_cast<double>(words[i]) * units.linear;
  const glm::dvec3 more = glm::cross(off, impulse);
  for (int i = 0; i < 3; ++i) words[3 + i] += in_units(more[i], units.angular);
}

/// One body's impulse as a wrench that acts for `dt` s.
inline Wrench impulse_wrench(std::span<const std::int64_t> words, const ImpulseUnits& units, double dt) {
  Wrench w;
  for (int i = 0; i < 3; ++i) {
    w.force[i] = static_cast<double>(words[i]) * units.linear / dt;
    w.torque[i] = static_cast<double>(words[3 + i]) * units.angular / dt;
  }
  return w;
}

}  // namespace slosh
