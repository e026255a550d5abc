#include "tests/lab/report/reference/released_ball.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace slosh::report {

double added_mass(const ReleasedBall& ball) {
  // Images in x and z: a tank's width apart, alike. In y: at the floor reversed, at the free surface reversed
  // twice.
  constexpr int kAcross = 60, kUp = 8;
  const double depth = ball.to_floor + ball.to_level;
  double stream = 0.0;  // of the ball's velocity, along it
  const auto add = [&](double y, double sign) {
    for (int i = -kAcross; i <= kAcross; ++i) {
      for (int k = -kAcross; k <= kAcross; ++k) {
        const double x = i * ball.width, z = k * ball.width, r2 = x * x + y * y + z * z;
        if (r2 == 0.0) continue;
        stream += sign * 0.5 * std::pow(ball.radius, 3) * (3.0 * y * y / r2 - 1.0) / (r2 * std::sqrt(r2));
      }
    }
  };
  for (int m = -kUp; m <= kUp; ++m) {
    const double around =
        m % 2 == 0 ? 1.0 : -1.0;  // a way there and back over floor and surface turns it once
    add(2.0 * m * depth, around);
    add(2.0 * m * depth - 2.0 * ball.to_floor, -around);
  }
  return 0.5 * (1.0 - 3.0 * stream);
}

double mean_acceleration(const ReleasedBall& ball, double gravity, double seconds) {
  // a(t) by steps: the mass that goes along · a = buoyancy − 6πμR v − 6R²√(πρμ) ∫ a(τ)/√(t − τ) dτ, each
  // step's a constant, its part of the integral in closed form.
  constexpr int kSteps = 400;
  const double dt = seconds / kSteps, pi = std::numbers::pi, r = ball.radius;
  const double displaced = ball.density * 4.0 / 3.0 * pi * r * r * r;
  const double mass = displaced * (ball.share + added_mass(ball));
  const double history = 6.0 * r * r * std::sqrt(pi * ball.density * ball.viscosity);
  const double stokes = 6.0 * pi * ball.viscosity * r;
  std::vector<double> a;
  double speed = 0.0;
  for (int n = 0; n < kSteps; ++n) {
    double past = 0.0;
    for (int k = 0; k < n; ++k) {
      const double since = (n + 1 - k) * dt;
      past += a[static_cast<std::size_t>(k)] * 2.0 * (std::sqrt(since) - std::sqrt(since - dt));
    }
    const double push = displaced * (1.0 - ball.share) * gravity - stokes * speed - history * past;
    a.push_back(push / (mass + history * 2.0 * std::sqrt(dt) + stokes * dt));
    speed += a.back() * dt;
  }
  return speed / seconds;
}

}  // namespace slosh::report
