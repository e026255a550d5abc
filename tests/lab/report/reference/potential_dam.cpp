#include "tests/lab/report/reference/potential_dam.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "sim/math/gauss.h"
#include "tests/lab/report/refused.h"

namespace slosh::report {
namespace {

using glm::dvec2;

constexpr double kGravity = 0.5;  // of lengths in L and times in √(L/2g)
// Lengths in the logarithm are in these: where a curve's logarithmic capacity is 1 the equation has no
// answer, and a dam's is less than that here.
constexpr double kUnit = 20.0;

// A cubic spline, at each end with a slope or a curvature of 0.
enum class End { kNoSlope, kNoCurvature };

class Spline {
 public:
  Spline(const std::vector<double>& at, std::vector<double> values, End first, End last)
      : at_(at), f_(std::move(values)), m_(f_.size(), 0.0) {
    const std::size_t n = f_.size();
    std::vector<double> below(n), middle(n, 1.0), above(n), rhs(n);
    const auto rise = [&](std::size_t i) { return (f_[i + 1] - f_[i]) / (at_[i + 1] - at_[i]); };
    for (std::size_t i = 1; i + 1 < n; ++i) {
      below[i] = at_[i] - at_[i - 1];
      above[i] = at_[i + 1] - at_[i];
      middle[i] = 2.0 * (below[i] + above[i]);
      rhs[i] = 6.0 * (rise(i) - rise(i - 1));
    }
    if (first == End::kNoSlope) {
      above[0] = at_[1] - at_[0];
      middle[0] = 2.0 * above[0];
      rhs[0] = 6.0 * rise(0);
    }
    if (last == End::kNoSlope) {
      below[n - 1] = at_[n - 1] - at_[n - 2];
      middle[n - 1] = 2.0 * below[n - 1];
      rhs[n - 1] = -6.0 * rise(n - 2);
    }
    for (std::size_t i = 1; i < n; ++i) {
      const double w = below[i] / middle[i - 1];
      middle[i] -= w * above[i - 1];
      rhs[i] -= w * rhs[i - 1];
    }
    m_[n - 1] = rhs[n - 1] / middle[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) m_[i] = (rhs[i] - above[i] * m_[i + 1]) / middle[i];
  }

  double operator()(double s) const {
    const auto [i, h, a, b] = place(s);
    return a * f_[i] + b * f_[i + 1] + ((a * a * a - a) * m_[i] + (b * b * b - b) * m_[i + 1]) * h * h / 6.0;
  }
  double slope(double s) const {
    const auto [i, h, a, b] = place(s);
    return (f_[i + 1] - f_[i]) / h +
           h / 6.0 * ((3.0 * b * b - 1.0) * m_[i + 1] - (3.0 * a * a - 1.0) * m_[i]);
  }

 private:
  struct Place {
    std::size_t i;
    double h, a, b;
  };
  Place place(double s) const {
    const auto next = std::upper_bound(at_.begin() + 1, at_.end() - 1, s);
    const auto i = static_cast<std::size_t>(next - at_.begin()) - 1;
    const double h = at_[i + 1] - at_[i];
    return {i, h, (at_[i + 1] - s) / h, (s - at_[i]) / h};
  }

  std::vector<double> at_, f_, m_;  // m_: second derivatives
};

struct Surface {
  std::vector<dvec2> points;
  std::vector<double> potential;
};

std::vector<double> lengths(const std::vector<dvec2>& points) {
  std::vector<double> s(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i) s[i] = s[i - 1] + glm::distance(points[i], points[i - 1]);
  return s;
}

// A surface as functions of the length along it. It meets wall and floor at right angles, as its mirror
// images make it.
struct Curve {
  std::vector<double> s;
  Spline x, y, potential;
  explicit Curve(const Surface& surface)
      : s(lengths(surface.points)),
        x(s, part(surface.points, 0), End::kNoCurvature, End::kNoSlope),
        y(s, part(surface.points, 1), End::kNoSlope, End::kNoCurvature),
        potential(s, surface.potential, End::kNoSlope, End::kNoSlope) {}

 private:
  static std::vector<double> part(const std::vector<dvec2>& points, int axis) {
    std::vector<double> values;
    for (const dvec2& p : points) values.push_back(p[axis]);
    return values;
  }
};

// ∫ ln r and ∫ ∂ln r/∂n along a straight element from `from` to `to`, seen from `eye`, each for the linear
// function that is 1 at its start and the one that is 1 at its end; n is to the right of the way. Closed
// forms, so that an image close by is no harder than one far off.
struct Element {
  double log[2], flux[2];
};
Element element(const dvec2& eye, const dvec2& from, const dvec2& to) {
  const double length = glm::distance(from, to);
  const dvec2 along = (to - from) / length, across(along.y, -along.x);
  const double a = glm::dot(from - eye, along), b = a + length, y = glm::dot(from - eye, across);
  const auto angle = [y](double x) { return y != 0.0 ? std::atan(x / y) : 0.0; };
  const auto square = [y](double x) { return x * x + y * y; };
  const auto log0 = [&](double x) {
    const double q = square(x);
    return (q > 0.0 ? 0.5 * x * std::log(q / (kUnit * kUnit)) : 0.0) - x + y * angle(x);
  };
  const auto log1 = [&](double x) {
    const double q = square(x);
    return q > 0.0 ? 0.25 * q * (std::log(q / (kUnit * kUnit)) - 1.0) : 0.0;
  };
  const double log = log0(b) - log0(a);
  const double log_end = (log1(b) - log1(a) - a * log) / length;
  const double flux = angle(b) - angle(a);
  const double flux_end = y != 0.0 ? (0.5 * y * std::log(square(b) / square(a)) - a * flux) / length : 0.0;
  return {{log - log_end, log_end}, {flux - flux_end, flux_end}};
}

std::vector<dvec2> velocities(const Surface& surface) {
  const std::vector<double> out = outward_speeds(surface.points, surface.potential);
  const Curve curve(surface);
  std::vector<dvec2> u;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double s = curve.s[i];
    const dvec2 way(curve.x.slope(s), curve.y.slope(s));
    const double length = glm::length(way);
    u.push_back((way * (curve.potential.slope(s) / length) + dvec2(-way.y, way.x) * out[i]) / length);
  }
  u.front() = {0.0, out.front()};
  u.back() = {out.back(), 0.0};
  return u;
}

Surface moved(const Surface& from, const std::vector<dvec2>& velocity, const std::vector<double>& gain,
              double dt) {
  Surface to = from;
  for (std::size_t i = 0; i < to.points.size(); ++i) {
    to.points[i] += dt * velocity[i];
    to.potential[i] += dt * gain[i];
  }
  return to;
}

// What its particles' potential gains a unit of time, where the pressure is 0 (Bernoulli).
std::vector<double> gains(const Surface& surface, const std::vector<dvec2>& velocity) {
  std::vector<double> gain;
  for (std::size_t i = 0; i < velocity.size(); ++i)
    gain.push_back(0.5 * glm::dot(velocity[i], velocity[i]) - kGravity * surface.points[i].y);
  return gain;
}

double longest_step(const Surface& surface, const std::vector<dvec2>& velocity) {
  double dt = 0.05;
  for (std::size_t i = 0; i + 1 < velocity.size(); ++i) {
    const double speed = 2.0 * glm::distance(velocity[i], velocity[i + 1]) + 0.3 * glm::length(velocity[i]);
    dt = std::min(dt, 0.4 * glm::distance(surface.points[i], surface.points[i + 1]) / std::max(speed, 1e-9));
  }
  return dt;
}

Surface stepped(const Surface& start, double dt, const std::vector<dvec2>& u1) {
  const std::vector<double> g1 = gains(start, u1);
  const Surface second = moved(start, u1, g1, 0.5 * dt);
  const std::vector<dvec2> u2 = velocities(second);
  const std::vector<double> g2 = gains(second, u2);
  const Surface third = moved(start, u2, g2, 0.5 * dt);
  const std::vector<dvec2> u3 = velocities(third);
  const std::vector<double> g3 = gains(third, u3);
  const Surface fourth = moved(start, u3, g3, dt);
  const std::vector<dvec2> u4 = velocities(fourth);
  const std::vector<double> g4 = gains(fourth, u4);
  Surface end = start;
  for (std::size_t i = 0; i < u1.size(); ++i) {
    end.points[i] += dt / 6.0 * (u1[i] + 2.0 * u2[i] + 2.0 * u3[i] + u4[i]);
    end.potential[i] += dt / 6.0 * (g1[i] + 2.0 * g2[i] + 2.0 * g3[i] + g4[i]);
  }
  return end;
}

// Points anew along the surface: close where it is thin, each way at most a fifth longer than the one before.
Surface regridded(const Surface& surface, const DamGrid& grid) {
  const Curve curve(surface);
  std::vector<double> at{curve.s.back()};
  double before = grid.finest;
  while (true) {
    const double deep = std::abs(curve.y(at.back()));
    const double way = std::min({grid.spacing, std::max(grid.finest, 0.5 * deep), 1.2 * before});
    if (at.back() - way < 0.5 * way) break;
    at.push_back(at.back() - way);
    before = way;
  }
  at.push_back(0.0);
  std::reverse(at.begin(), at.end());
  Surface anew;
  for (const double s : at) {
    anew.points.emplace_back(curve.x(s), curve.y(s));
    anew.potential.push_back(curve.potential(s));
  }
  anew.points.front().x = 0.0;
  anew.points.back().y = 0.0;
  return anew;
}

// Longuet-Higgins and Cokelet's five points take out what alternates from point to point and leave any cubic.
void smooth(Surface& surface) {
  const Surface old = surface;
  const auto mean = [](const auto& v, std::size_t i) {
    return (-v[i - 2] + 4.0 * v[i - 1] + 10.0 * v[i] + 4.0 * v[i + 1] - v[i + 2]) / 16.0;
  };
  for (std::size_t i = 2; i + 2 < old.points.size(); ++i) {
    surface.points[i] = mean(old.points, i);
    surface.potential[i] = mean(old.potential, i);
  }
}

// Ends a tongue that is longer than half as much again as it is thick there with a quarter of an ellipse: its
// tip would be thinner than any grid, and presses on nothing.
void cut_tongue(Surface& surface, double thickness) {
  std::vector<dvec2>& points = surface.points;
  std::vector<double>& potential = surface.potential;
  std::size_t last = points.size() - 1;
  while (last > 2 && points[last].y < thickness) --last;
  const dvec2 a = points[last], b = points[last + 1];
  const double share = (a.y - thickness) / (a.y - b.y);
  const double from = glm::mix(a.x, b.x, share);
  const double there = glm::mix(potential[last], potential[last + 1], share);
  double tip = from;
  for (std::size_t i = last + 1; i < points.size(); ++i) tip = std::max(tip, points[i].x);
  if (tip - from <= 1.5 * thickness && tip <= points.back().x + 1e-12) return;
  const double speed = (potential[last] - potential[last - 2]) / (a.x - points[last - 2].x);
  const double length = std::min(tip - from, thickness);
  const bool close = glm::distance(a, dvec2(from, thickness)) < 0.2 * thickness;
  points.resize(close ? last : last + 1);
  potential.resize(points.size());
  constexpr int kPoints = 6;
  for (int k = 0; k <= kPoints; ++k) {
    const double angle = 0.5 * std::numbers::pi * (1.0 - static_cast<double>(k) / kPoints);
    points.emplace_back(from + length * std::cos(angle), thickness * std::sin(angle));
    potential.push_back(there + speed * length * std::cos(angle));
  }
  points.back().y = 0.0;
}

// A column at rest, its upper corner a little round.
Surface column(double height, const DamGrid& grid) {
  constexpr double kRound = 0.02;
  Surface surface;
  const int top = static_cast<int>(1.0 / grid.spacing);
  for (int i = 0; i <= top; ++i) surface.points.emplace_back((1.0 - kRound) * i / top, height);
  for (int k = 1; k < 8; ++k) {
    const double angle = 0.5 * std::numbers::pi * (1.0 - k / 8.0);
    surface.points.emplace_back(1.0 - kRound + kRound * std::cos(angle),
                                height - kRound + kRound * std::sin(angle));
  }
  const int side = static_cast<int>((height - kRound) / grid.spacing);
  for (int i = 0; i <= side; ++i) surface.points.emplace_back(1.0, (height - kRound) * (side - i) / side);
  surface.potential.assign(surface.points.size(), 0.0);
  return regridded(surface, grid);
}

}  // namespace

std::vector<double> outward_speeds(const std::vector<dvec2>& points, const std::vector<double>& potential) {
  const std::size_t n = points.size();
  std::vector<double> matrix(n * n, 0.0), rhs(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (const dvec2 side : {dvec2(1, 1), dvec2(-1, 1), dvec2(1, -1), dvec2(-1, -1)}) {
      // Fluid lies to the right of the way from wall to tip; of an image mirrored once, to the left.
      const double outwards = -side.x * side.y;
      for (std::size_t j = 0; j + 1 < n; ++j) {
        const Element e = element(points[i], side * points[j], side * points[j + 1]);
        for (std::size_t k = 0; k < 2; ++k) {
          matrix[i * n + j + k] += e.log[k];
          // Less what a constant gives, which is the angle at the point: no angle needs to be known.
          rhs[i] += outwards * e.flux[k] * (potential[j + k] - potential[i]);
        }
      }
    }
  }
  if (!solve_dense(matrix, rhs) ||
      !std::all_of(rhs.begin(), rhs.end(), [](double speed) { return std::isfinite(speed); }))
    throw Refused({"a dam's potential flow", "its " + std::to_string(n) + " points have no speeds",
                   "give it another grid"});
  return rhs;
}

std::vector<DamSurface> potential_dam(double height, double until, const DamGrid& grid) {
  constexpr int kSmoothEvery = 5;
  Surface surface = column(height, grid);
  std::vector<DamSurface> all{{0.0, surface.points}};
  for (int step = 1; all.back().time < until; ++step) {
    const std::vector<dvec2> velocity = velocities(surface);
    const double dt = longest_step(surface, velocity);
    surface = regridded(stepped(surface, dt, velocity), grid);
    if (step % kSmoothEvery == 0) smooth(surface);
    cut_tongue(surface, grid.tip);
    surface = regridded(surface, grid);
    all.push_back({all.back().time + dt, surface.points});
  }
  return all;
}

double front_at(const std::vector<DamSurface>& surfaces, double time, double thickness) {
  const auto front = [thickness](const std::vector<dvec2>& points) {
    std::size_t i = points.size() - 1;
    while (i > 0 && points[i].y < thickness) --i;
    if (i + 1 == points.size()) return points[i].x;
    const dvec2 a = points[i], b = points[i + 1];
    return glm::mix(a.x, b.x, (a.y - thickness) / (a.y - b.y));
  };
  std::size_t i = 1;
  while (i + 1 < surfaces.size() && surfaces[i].time < time) ++i;
  const DamSurface &a = surfaces[i - 1], &b = surfaces[i];
  return glm::mix(front(a.points), front(b.points), (time - a.time) / (b.time - a.time));
}

}  // namespace slosh::report
