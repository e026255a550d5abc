#include "peer/devices/falcon_kinematics.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
// m: arm, forearm's rods, the forearm's offset at the platform, both halves of its ends together, the arms'
// pivots from the middle, and how far the platform's ends stand aside of them.
constexpr double kArm = 0.060;
constexpr double kRod = 0.1025;
constexpr double kPlatform = 0.01443;
constexpr double kEnds = 0.01125 + 0.01125;
constexpr double kBase = 0.040;
constexpr double kAside = 0.02309 - 0.025;
constexpr std::array<double, 3> kLegs{105.0 * kDegree, -15.0 * kDegree, -135.0 * kDegree};

/// The grip as leg `i` sees it: outwards from its pivot, aside, and towards the user.
struct InLeg {
  double out, aside, forward;
};
InLeg in_leg(const glm::dvec3& p, std::size_t i) {
  const double c = std::cos(kLegs[i]);
  const double s = std::sin(kLegs[i]);
  return {c * p.x + s * p.y - kBase + kPlatform, -s * p.x + c * p.y + kAside, p.z};
}

/// The forearm's length in the plane of its arm.
double reach(double aside) {
  return kEnds + std::sqrt(std::max(kRod * kRod - aside * aside, 0.0));
}

/// How far (m²) the grip is from where the forearm can be, and by what that changes.
struct Closure {
  double off;
  glm::dvec3 by_place;
  double by_angle;
};
Closure closure(const glm::dvec3& p, double angle, std::size_t i) {
  const InLeg g = in_leg(p, i);
  const double u = g.out - kArm * std::cos(angle);
  const double w = g.forward - kArm * std::sin(angle);
  const double length = reach(g.aside);
  const double rod = std::max(length - kEnds, 1e-9);
  const double c = std::cos(kLegs[i]);
  const double s = std::sin(kLegs[i]);
  const double by_aside = 2.0 * length * g.aside / rod;
  return {u * u + w * w - length * length,
          glm::dvec3(2.0 * u * c - by_aside * s, 2.0 * u * s + by_aside * c, 2.0 * w),
          2.0 * kArm * (u * std::sin(angle) - w * std::cos(angle))};
}

/// The matrix of three rows.
glm::dmat3 rows(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return glm::transpose(glm::dmat3(a, b, c));
}

}  // namespace

FalconAngles falcon_angles(const glm::dvec3& grip, bool& reachable) {
  FalconAngles angles{};
  reachable = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const InLeg g = in_leg(grip, i);
    const double length = reach(g.aside);
    const double far = std::hypot(g.out, g.forward);
    // The triangle of arm, forearm and the way from pivot to platform; the elbow is on the outer side.
    const double cosine = (far * far + kArm * kArm - length * length) / (2.0 * kArm * far);
    if (!(std::abs(cosine) <= 1.0) || std::abs(g.aside) > kRod) reachable = false;
    angles[i] = std::atan2(g.forward, g.out) - std::acos(std::clamp(cosine, -1.0, 1.0));
  }
  return angles;
}

std::optional<glm::dvec3> falcon_grip(const FalconAngles& angles, const glm::dvec3& near) {
  constexpr int kMaxSteps = 30;
  constexpr double kEnough = 1e-14;  // m
  constexpr double kMaxStep = 0.05;
  glm::dvec3 p = near;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Closure a = closure(p, angles[0], 0);
    const Closure b = closure(p, angles[1], 1);
    const Closure c = closure(p, angles[2], 2);
    const glm::dmat3 slope = rows(a.by_place, b.by_place, c.by_place);
    if (std::abs(glm::determinant(slope)) < 1e-12) return std::nullopt;
    glm::dvec3 move = -(glm::inverse(slope) * glm::dvec3(a.off, b.off, c.off));
    const double length = glm::length(move);
    if (!std::isfinite(length)) return std::nullopt;
    if (length > kMaxStep) move *= kMaxStep / length;
    p += move;
    if (length < kEnough) break;
  }
  // The equations also have answers with an elbow on its inner side, and the last digits may go round in
  // circles: what counts is that these are the place's angles.
  bool reachable = false;
  const FalconAngles back = falcon_angles(p, reachable);
  for (std::size_t i = 0; i < 3; ++i)
    if (!reachable || std::abs(back[i] - angles[i]) > 1e-9) return std::nullopt;
  return p;
}

glm::dmat3 falcon_jacobian(const glm::dvec3& grip, const FalconAngles& angles) {
  std::array<glm::dvec3, 3> row;
  for (std::size_t i = 0; i < 3; ++i) {
    const Closure c = closure(grip, angles[i], i);
    row[i] = -c.by_place / c.by_angle;
  }
  return rows(row[0], row[1], row[2]);
}

std::optional<glm::dvec3> falcon_torques(const glm::dvec3& grip, const FalconAngles& angles,
                                         const glm::dvec3& force) {
  // Power is the same at both ends: force · velocity = torques · J · velocity.
  const glm::dmat3 across = glm::transpose(falcon_jacobian(grip, angles));
  if (!(std::abs(glm::determinant(across)) > 1e-3)) return std::nullopt;
  const glm::dvec3 torques = glm::inverse(across) * force;
  if (!std::isfinite(glm::length(torques))) return std::nullopt;
  return torques;
}

// A count is a 1280th of a motor's turn, its pinion of 14.25 mm drives the arm's sector of 110 mm.
constexpr double kRadPerCount = (0.01425 / 1280.0) * 360.0 / 0.110 * kDegree;
constexpr double kAtZero = 35.0 * kDegree;

double falcon_angle_of(int count) {
  return kRadPerCount * count + kAtZero;
}
double falcon_count_of(double angle) {
  return (angle - kAtZero) / kRadPerCount;
}

}  // namespace slosh
