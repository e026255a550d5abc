#include "sim/fluid_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace slosh {
namespace {

/// A cell's number; cells lie within 2²⁰ of the origin along each axis.
std::uint64_t cell_number(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::int64_t kHalf = std::int64_t{1} << 20;
  const auto part = [](std::int64_t i) { return static_cast<std::uint64_t>(i + kHalf) & 0x1fffff; };
  return part(x) << 42 | part(y) << 21 | part(z);
}
std::int64_t cell_along(double x, double width) {
  return static_cast<std::int64_t>(std::floor(x / width));
}

}  // namespace

Spread spread_of(std::span<const glm::vec3> places, const glm::dvec3& up, double spacing) {
  constexpr double kWide = 2.0;  // spacings
  const double width = kWide * spacing;
  const glm::dvec3 across = std::abs(up.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(up, across));
  const glm::dvec3 v = glm::cross(up, u);
  struct Column {
    std::int64_t x, y;
    double particles;
  };
  std::unordered_map<std::uint64_t, Column> columns;
  for (const glm::vec3& place : places) {
    const glm::dvec3 p(place);
    const std::int64_t x = cell_along(glm::dot(p, u), width), y = cell_along(glm::dot(p, v), width);
    const auto [column, is_new] = columns.try_emplace(cell_number(x, y, 0), Column{x, y, 0.0});
    column->second.particles += 1.0;
  }
  Spread spread;
  double inner = 0.0, sum = 0.0, squares = 0.0;
  for (const auto& [number, column] : columns) {
    spread.area += width * width * std::min(column.particles / (kWide * kWide), 1.0);
    const auto covered = [&](std::int64_t dx, std::int64_t dy) {
      return columns.contains(cell_number(column.x + dx, column.y + dy, 0));
    };
    if (!covered(-1, 0) || !covered(1, 0) || !covered(0, -1) || !covered(0, 1)) continue;
    inner += 1.0;
    sum += column.particles;
    squares += column.particles * column.particles;
  }
  if (inner > 0.0) {
    const double mean = sum / inner;
    const double variance = std::max(squares / inner - mean * mean, 0.0);
    spread.evenness = std::max(1.0 - std::sqrt(variance) / mean, 0.0);
  }
  return spread;
}

double mixing_index(std::span<const glm::vec3> places, std::span<const std::uint8_t> of_it, double spacing) {
  constexpr double kWide = 2.0;                          // spacings
  constexpr double kFull = 0.5 * kWide * kWide * kWide;  // particles
  const double width = kWide * spacing;
  struct Sample {
    double all = 0.0, of_it = 0.0;
  };
  std::unordered_map<std::uint64_t, Sample> samples;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec3 p(places[i]);
    Sample& sample =
        samples[cell_number(cell_along(p.x, width), cell_along(p.y, width), cell_along(p.z, width))];
    sample.all += 1.0;
    sample.of_it += of_it[i];
  }
  double particles = 0.0, wanted = 0.0, full = 0.0;
  for (const auto& [number, sample] : samples) {
    if (sample.all < kFull) continue;
    particles += sample.all;
    wanted += sample.of_it;
    full += 1.0;
  }
  const double share = wanted / particles;
  if (!(share > 0.0 && share < 1.0)) return std::numeric_limits<double>::quiet_NaN();
  double variance = 0.0;
  for (const auto& [number, sample] : samples) {
    if (sample.all < kFull) continue;
    const double off = sample.of_it / sample.all - share;
    variance += sample.all * off * off;
  }
  variance /= particles;
  const double apart = share * (1.0 - share), by_chance = apart * full / particles;
  return std::clamp((apart - variance) / (apart - by_chance), 0.0, 1.0);
}

}  // namespace slosh
