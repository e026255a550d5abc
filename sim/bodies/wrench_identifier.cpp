#include "sim/bodies/wrench_identifier.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

constexpr double kSpan = 0.006;      // s over which changes are looked at
constexpr double kMemory = 0.4;      // s, the forgetting's time constant
constexpr double kFirstShare = 0.4;  // of the drag with the fluid held, before anything is learnt
// Motion whose changes over the span weigh as much as what is taken to be so beforehand.
constexpr double kUsualChange = 0.01;        // m/s
constexpr double kUsualAcceleration = 0.15;  // m/s²
constexpr double kUsualWay = 0.0001;         // m
constexpr double kLongestCarry = 0.03;       // s
constexpr double kQuietFactor = 1.5;         // times the usual rest
constexpr double kAlike = 0.5;               // share of change in the drag at which the line ends
constexpr double kFarthest = 8.0;            // reaches

Vector6 six(const glm::dvec3& linear, const glm::dvec3& angular) {
  return {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
}

Vector6 minus(const Vector6& a, const Vector6& b) {
  Vector6 d;
  for (std::size_t i = 0; i < 6; ++i) d[i] = a[i] - b[i];
  return d;
}

Vector6 times(const Matrix6& m, const Vector6& v) {
  Vector6 r{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) r[i] += m[i][j] * v[j];
  }
  return r;
}

double along(const Vector6& a, const Vector6& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

double mean_diagonal(const Matrix6& m) {
  return (m[0][0] + m[1][1] + m[2][2]) / 3.0;
}

bool all_finite(const Vector6& v) {
  return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

void WrenchIdentifier::restart(const WrenchBounds& bounds) {
  *this = WrenchIdentifier{};
  bounds_ = bounds;
}

std::size_t WrenchIdentifier::lag(double time_step) const {
  const double steps = std::round(kSpan / std::max(time_step, 1e-9));
  return static_cast<std::size_t>(std::clamp(steps, 1.0, static_cast<double>(kKept / 2 - 1)));
}

// D and H of this reading.
void WrenchIdentifier::shape(const FluidReading& reading) {
  d_ = {};
  h_ = {};
  glm::dvec3 middle(0.0);
  if (reading.drag) {
    const Matrix6& d = *reading.drag;
    const double mean = mean_diagonal(d);
    wet_ = mean > 0.0;
    if (!wet_) return;
    d_ = d;
    middle = glm::dvec3(d[1][5] - d[2][4], d[2][3] - d[0][5], d[0][4] - d[1][3]) / (2.0 * mean);
    arm_squared_ = std::max((d[3][3] + d[4][4] + d[5][5]) / (3.0 * mean), 1e-8);
  } else {
    wet_ = glm::dot(reading.wrench.force, reading.wrench.force) > 0.0;
    arm_squared_ = std::max(bounds_.gyration_squared, 1e-8);
    for (std::size_t i = 0; i < 6; ++i) d_[i][i] = wet_ ? (i < 3 ? 1.0 : arm_squared_) : 0.0;
  }
  h_ = six(bounds_.up, glm::cross(middle, bounds_.up));
}

void WrenchIdentifier::add(const FluidReading& reading) {
  Entry now;
  now.time = reading.time;
  now.center = reading.center;
  now.twist = six(reading.twist.linear, reading.twist.angular);
  now.wrench = six(reading.wrench.force, reading.wrench.torque);
  const bool sound = all_finite(now.twist) && all_finite(now.wrench) && std::isfinite(reading.time);
  const double time_step = count_ > 0 ? now.time - back(0).time : 0.0;
  if (!sound || (count_ > 0 && !(time_step > 0.0))) return restart(WrenchBounds(bounds_));
  if (count_ > 0) {
    now.mean_acceleration = minus(now.twist, back(0).twist);
    for (double& each : now.mean_acceleration) each /= time_step;
    // From the middle of the step to the middle of its last sub-step.
    const double on = count_ > 1 ? 0.5 - 0.5 / std::max(reading.sub_steps, 1) : 0.0;
    const Vector6 change = minus(now.mean_acceleration, back(0).mean_acceleration);
    for (std::size_t i = 0; i < 6; ++i) now.acceleration[i] = now.mean_acceleration[i] + on * change[i];
    lag_ = lag(time_step);
  }
  shape(reading);
  now.drag = mean_diagonal(d_);
  const double learnt = count_ > 0 ? 1.0 - std::exp(-time_step / kMemory) : 1.0;
  usual_drag_ += learnt * (now.drag - usual_drag_);
  entries_[count_ % kKept] = now;
  count_ += 1;
  // The first acceleration is the second reading's.
  if (count_ > lag_ + 1)
    learn(back(lag_), entries_[(count_ - 1) % kKept], time_step);
  else
    solve();
}

void WrenchIdentifier::learn(const Entry& before, Entry& now, double time_step) {
  const double keep = std::exp(-time_step / kMemory);
  const double span = now.time - before.time;
  const glm::dvec3 moved = now.center.position - before.center.position;
  const glm::dvec3 turned = rotation_between(before.center.orientation, now.center.orientation);
  const std::array<Vector6, kUnknowns> features{times(d_, minus(now.twist, before.twist)),
                                                times(d_, minus(now.acceleration, before.acceleration)), [&] {
                                                  Vector6 spring = h_;
                                                  const double way = along(h_, six(moved, turned));
                                                  for (double& each : spring) each *= way;
                                                  return spring;
                                                }()};
  const Vector6 change = minus(now.wrench, before.wrench);
  const auto weighed = [&](const Vector6& a, const Vector6& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i] / (i < 3 ? 1.0 : arm_squared_);
    return sum;
  };
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    for (std::size_t j = 0; j < kUnknowns; ++j)
      seen_[i][j] = keep * seen_[i][j] + time_step * weighed(features[i], features[j]);
    answer_[i] = keep * answer_[i] - time_step * weighed(features[i], change);
  }
  solve();
  for (std::size_t i = 0; i < 6; ++i) {
    double rest = change[i];
    for (std::size_t u = 0; u < kUnknowns; ++u) rest += found_[u] * features[u][i];
    now.rest[i] = rest / span;
  }
  now.rested = true;
  if (before.rested) learn_rest(before, now, keep);
  note_alike(before, now, keep);
}

// How much of a rest was there again a span later.
void WrenchIdentifier::learn_rest(const Entry& before, const Entry& now, double keep) {
  rests_ = keep * rests_ + 1.0;
  for (std::size_t part = 0; part < 2; ++part) {
    double product = 0.0;
    double square = 0.0;
    for (std::size_t i = 3 * part; i < 3 * part + 3; ++i) {
      product += now.rest[i] * before.rest[i];
      square += before.rest[i] * before.rest[i];
    }
    rest_product_[part] = keep * rest_product_[part] + product;
    rest_square_[part] = keep * rest_square_[part] + square;
    share_[part] =
        rest_square_[part] > 0.0 ? std::clamp(rest_product_[part] / rest_square_[part], 0.0, 1.0) : 0.0;
  }
}

// How fast the drag changes along the body's way: a body that leaves the fluid has another line soon.
void WrenchIdentifier::note_alike(const Entry& before, const Entry& now, double keep) {
  if (!(usual_drag_ > 0.0)) return;
  const double way = glm::distance(now.center.position, before.center.position);
  const double change = (now.drag - before.drag) / usual_drag_;
  change_square_ = keep * change_square_ + change * change;
  way_square_ = keep * way_square_ + way * way;
}

void WrenchIdentifier::solve() {
  const double drag = std::max(usual_drag_, 1e-12);
  const std::array<double, kUnknowns> usual{drag * kUsualChange, drag * kUsualAcceleration, kUsualWay};
  const std::array<double, kUnknowns> first{kFirstShare, 0.0, 0.0};
  std::array<bool, kUnknowns> out{};
  if (h_ == Vector6{}) out[2] = true;
  // What comes out negative is left out, the worst first, and the rest found again.
  while (true) {
    Matrix6 a{};
    Vector6 b{};
    for (std::size_t i = 0; i < 6; ++i) a[i][i] = 1.0;
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      if (out[i]) continue;
      const double prior = kMemory * usual[i] * usual[i];
      a[i][i] = seen_[i][i] + prior;
      for (std::size_t j = 0; j < kUnknowns; ++j) {
        if (j != i && !out[j]) a[i][j] = seen_[i][j];
      }
      b[i] = answer_[i] + prior * first[i];
    }
    // Brought to a unit diagonal: the three have different units.
    Vector6 scale;
    for (std::size_t i = 0; i < 6; ++i) scale[i] = 1.0 / std::sqrt(a[i][i]);
    for (std::size_t i = 0; i < 6; ++i) {
      b[i] *= scale[i];
      for (std::size_t j = 0; j < 6; ++j) a[i][j] *= scale[i] * scale[j];
    }
    Matrix6 factor;
    if (!cholesky(a, factor)) return;
    Vector6 x = cholesky_solve(factor, b);
    if (!all_finite(x)) return;
    std::size_t worst = kUnknowns;
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      if (x[i] < 0.0 && (worst == kUnknowns || x[i] < x[worst])) worst = i;
    }
    if (worst < kUnknowns) {
      out[worst] = true;
      continue;
    }
    for (std::size_t i = 0; i < kUnknowns; ++i) found_[i] = out[i] ? 0.0 : x[i] * scale[i];
    break;
  }
  // Faster than the span nothing can be told from noise.
  found_[1] = std::min(found_[1], bounds_.fluid_mass / drag);
  const double mass = bounds_.body_mass + drag * found_[1];
  found_[0] = std::min(found_[0], std::max(1.0, mass / (kSpan * drag)));
  found_[2] = std::min(found_[2], mass / (kSpan * kSpan));
}

void WrenchIdentifier::fill(FluidWrenchModel& model) const {
  const Entry& now = back(0);
  model.time = now.time;
  model.reference = now.center;
  model.twist = {{now.twist[0], now.twist[1], now.twist[2]}, {now.twist[3], now.twist[4], now.twist[5]}};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      model.d_velocity[i][j] = -found_[0] * d_[i][j];
      model.added_mass[i][j] = found_[1] * d_[i][j];
      model.d_pose[i][j] = wet_ ? -found_[2] * h_[i] * h_[j] : 0.0;
    }
  }
  Vector6 wrench = times(model.added_mass, now.acceleration);
  for (std::size_t i = 0; i < 6; ++i) wrench[i] += now.wrench[i];
  model.wrench = {{wrench[0], wrench[1], wrench[2]}, {wrench[3], wrench[4], wrench[5]}};
  model.rate = Wrench{};
  model.rate_span = 0.0;
  if (wet_ && now.rested) {
    // Rests that are there again by this share after each span add up to so long a way.
    const auto carry = [](double share) { return std::min(kLongestCarry, kSpan * share / (1.001 - share)); };
    const double span = std::max(carry(share_[0]), carry(share_[1]));
    const auto part = [&](std::size_t which) {
      return span > 0.0 ? share_[which] * carry(share_[which]) / span : 0.0;
    };
    // An impact is over before it could be carried on.
    const auto calm = [&](std::size_t which, const glm::dvec3& rest) {
      const double usual = std::sqrt(rest_square_[which] / std::max(rests_, 1.0));
      const double size = glm::length(rest);
      return size > kQuietFactor * usual ? rest * (kQuietFactor * usual / size) : rest;
    };
    model.rate.force = part(0) * calm(0, {now.rest[0], now.rest[1], now.rest[2]});
    model.rate.torque = part(1) * calm(1, {now.rest[3], now.rest[4], now.rest[5]});
    model.rate_span = span;
  }
  const double farthest = kFarthest * bounds_.reach;
  const double alike = change_square_ > 0.0 ? kAlike * std::sqrt(way_square_ / change_square_) : farthest;
  model.trust_radius = std::clamp(alike, 0.5 * bounds_.reach, farthest);
  model.trust_angle = std::min(1.0, model.trust_radius / std::sqrt(arm_squared_));
}

}  // namespace slosh
