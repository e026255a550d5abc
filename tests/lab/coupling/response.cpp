#include "tests/lab/coupling/response.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace slosh::coupling {
namespace {

constexpr double kResponsePeriod = 0.001;  // s, of the device loop
constexpr double kNear = 1.5;              // Hz

using Phasor = std::complex<double>;

/// Σ value(i)·e^(−2πi·f·t) over `count` ticks from `first` on, by a turning phasor.
template <class Value>
Phasor turned_sum(double frequency, std::size_t first, std::size_t count, Value&& value) {
  const Phasor step = std::polar(1.0, -2.0 * std::numbers::pi * frequency * kResponsePeriod);
  Phasor turn =
      std::polar(1.0, -2.0 * std::numbers::pi * frequency * kResponsePeriod * static_cast<double>(first));
  Phasor sum = 0.0;
  for (std::size_t i = first; i < first + count; ++i, turn *= step) sum += value(i) * turn;
  return sum;
}

Phasor phasor(const Impedance& z) {
  return std::polar(z.size, z.phase);
}

}  // namespace

std::vector<double> transparency_tones() {
  return {0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.2, 3.3, 4.7, 6.8, 10.0, 14.7, 20.6, 30.0};
}

std::vector<Impedance> impedance(const Outcome& run, int hands, const std::vector<double>& tones,
                                 double seconds) {
  const auto n = static_cast<std::size_t>(hands);
  const std::size_t ticks = std::min(run.handles.size(), run.felt.size() / n);
  const auto count = std::min(static_cast<std::size_t>(std::lround(seconds / kResponsePeriod)), ticks);
  const std::size_t first = ticks - count;
  std::vector<Impedance> out;
  for (const double f : tones) {
    const Phasor way = turned_sum(f, first, count, [&](std::size_t i) { return run.handles[i].position.x; });
    const Phasor speed = Phasor(0.0, 2.0 * std::numbers::pi * f) * way;
    // On the hand: against what it is moved with.
    const Phasor force = turned_sum(f, first, count, [&](std::size_t i) { return -run.felt[i * n].force.x; });
    const Phasor z = std::abs(speed) > 0.0 ? force / speed : Phasor(0.0);
    out.push_back({f, std::abs(z), std::arg(z)});
  }
  return out;
}

double farthest_off(const std::vector<Impedance>& rendered, const std::vector<Impedance>& commanded) {
  double most = 0.0;
  for (std::size_t i = 0; i < std::min(rendered.size(), commanded.size()); ++i) {
    if (!(commanded[i].size > 0.0)) continue;
    most = std::max(most, std::abs(phasor(rendered[i]) - phasor(commanded[i])) / commanded[i].size);
  }
  return most;
}

std::vector<Line> force_spectrum(const Outcome& run, int hands, double from, double to) {
  const auto n = static_cast<std::size_t>(hands);
  const auto first = static_cast<std::size_t>(std::lround(from / kResponsePeriod));
  const std::size_t last =
      std::min(static_cast<std::size_t>(std::lround(to / kResponsePeriod)), run.felt.size() / n);
  std::vector<Line> lines;
  if (last <= first) return lines;
  const std::size_t count = last - first;
  double mean = 0.0;
  for (std::size_t i = first; i < last; ++i) mean += run.felt[i * n].force.x / static_cast<double>(count);
  std::vector<double> windowed(count);
  double weight = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double w =
        0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count));
    windowed[i] = w * (run.felt[(first + i) * n].force.x - mean);
    weight += w;
  }
  const double finest = 1.0 / (kResponsePeriod * static_cast<double>(count));
  for (double f = std::max(finest, 1.0); f < 0.5 / kResponsePeriod; f += finest) {
    const Phasor sum = turned_sum(f, 0, count, [&](std::size_t i) { return windowed[i]; });
    lines.push_back({f, 2.0 * std::abs(sum) / weight});
  }
  return lines;
}

double tone_at(const std::vector<Line>& spectrum, double frequency) {
  double most = 0.0, tone = 0.0;
  for (const Line& line : spectrum) {
    most = std::max(most, line.force);
    if (std::abs(line.frequency - frequency) <= kNear) tone = std::max(tone, line.force);
  }
  return most > 0.0 ? tone / most : 0.0;
}

}  // namespace slosh::coupling
