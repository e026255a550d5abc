// What the codec's tests share: worlds in numbers, and what a decoded picture must be.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "net/codec/snapshot_codec.h"
#include "sim/snapshot.h"

namespace slosh::codec_kit {

/// A swirl with noise: every particle moves, some fast.
inline Snapshot swirl(std::size_t count, int frame, double noise = 0.0005, double turn = 0.02) {
  Snapshot s;
  s.rigid.time = frame / 60.0;
  std::mt19937 place(7);
  std::mt19937 shake(static_cast<unsigned>(frame) + 100);
  std::uniform_real_distribution<double> in(-0.15, 0.15);
  std::normal_distribution<double> jitter(0.0, noise);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = in(place), y = in(place), z = in(place);
    const double angle = turn * frame * (1.0 + y);
    s.positions.emplace_back(x * std::cos(angle) - z * std::sin(angle) + jitter(shake), y + jitter(shake),
                             x * std::sin(angle) + z * std::cos(angle) + jitter(shake));
    s.fluid_index.push_back(static_cast<std::uint8_t>(x > 0.1 ? 1 : 0));
  }
  return s;
}

using Row = std::array<long, 4>;  // lattice point and fluid

/// The lattice points of what is drawn, sorted: what both ends must agree on.
inline std::vector<Row> rows(const std::vector<glm::vec3>& positions, const std::vector<std::uint8_t>& fluids,
                             double tolerance) {
  std::vector<Row> out;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (fluids[i] == 255 || !std::isfinite(positions[i].x + positions[i].y + positions[i].z)) continue;
    Row row{0, 0, 0, fluids[i]};
    for (int a = 0; a < 3; ++a)
      row[static_cast<std::size_t>(a)] = std::lrint(positions[i][a] * (1.0 / (2.0 * tolerance)));
    out.push_back(row);
  }
  std::sort(out.begin(), out.end());
  return out;
}
inline std::vector<Row> rows(const Snapshot& s, double tolerance) {
  return rows(s.positions, s.fluid_index, tolerance);
}
inline std::vector<Row> rows(const DecodedFrame& f, double tolerance) {
  return rows(f.positions, f.fluid_index, tolerance);
}

}  // namespace slosh::codec_kit
