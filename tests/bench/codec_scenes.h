// The two flows that the codec is measured on, as snapshots 60 times a second, simulated once and kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/math/result.h"
#include "sim/snapshot.h"
#include "tests/support/tank.h"

namespace slosh::bench {

enum class Flow { kStirred, kDamBreak };

struct FlowOptions {
  Flow flow = Flow::kStirred;
  int side = 32;          ///< particles along an edge of the fluid's cube: side³ of them
  double spacing = 0.01;  ///< m
  double seconds = 4.0;   ///< simulated
  double snapshot_rate = 60.0;
};

struct Recorded {
  std::string geometry;  ///< in words, with sizes
  double spacing = 0.0;  ///< m
  std::vector<Snapshot> frames;
};

/// The tank, the fluid and for kStirred a paddle (body 1) held by one grip. Exactly side³ fluid particles.
testing::Tank make_flow(const FlowOptions& options);

/// Where the hand that stirs is at a time: a circle, 0.28 m/s in the tank of 32³ particles at 1 cm.
Pose stirring_hand(const FlowOptions& options, double time);

/// Simulates, or reads `cache` where it holds these options' frames; writes it after simulating. An empty
/// path: no cache. Errors: a cache that cannot be written.
Result<Recorded> record_flow(const FlowOptions& options, const std::filesystem::path& cache);
/// Simulates without keeping anything.
Recorded run_flow(const FlowOptions& options);

}  // namespace slosh::bench
