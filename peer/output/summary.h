// What a run amounted to: summary.json, and the same in words.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "peer/output/machine.h"
#include "sim/math/result.h"

namespace slosh {

/// Percentiles of a duration, in the unit that the field's name says.
struct Spread {
  double p50 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

struct DeviceSummary {
  std::string grip;          ///< the grip's name in the scene
  std::string device;        ///< script, mouse, replay
  double peak_force = 0.0;   ///< N, on the hand
  double peak_torque = 0.0;  ///< N·m
};

/// Plain numbers, filled from the host's and the peer's reports.
struct RunSummary {
  std::string scene;
  std::string scene_file;
  double spacing = 0.0;  ///< m
  std::string spacing_reason;
  std::size_t fluid_particles = 0;
  std::size_t boundary_particles = 0;
  std::uint64_t retired_particles = 0;
  std::uint64_t steps = 0;
  double time_step = 0.0;         ///< s
  double simulated = 0.0;         ///< s
  double wall = 0.0;              ///< s of the run itself
  double real_time_factor = 0.0;  ///< simulated over wall
  Spread step_ms;
  double share_sort = 0.0, share_density = 0.0, share_force = 0.0, share_body = 0.0;  ///< of the step, 0–1
  Spread device_loop_us;  ///< period, wake to wake
  std::uint64_t device_ticks = 0;
  std::uint64_t device_missed = 0;
  std::string device_scheduler;
  bool rendered = false;
  std::string renderer;
  int width = 0, height = 0;
  std::uint64_t frames = 0;
  std::uint64_t frames_dropped = 0;
  Spread frame_ms;
  std::uint32_t status = 0;  ///< StatusBits
  std::uint64_t slips = 0;
  double slipped = 0.0;  ///< s
  std::uint64_t rejected_poses = 0;
  std::uint64_t samples_lost = 0;
  double fluid_mass_start = 0.0;  ///< kg
  double fluid_mass_end = 0.0;    ///< kg still in the world
  std::vector<DeviceSummary> devices;
  std::string backend;
  int threads = 1;
  Machine machine;
  std::string version;
  bool interrupted = false;
  std::vector<std::string> files;  ///< written, summary.json included
  std::string folder;
};

nlohmann::ordered_json to_json(const RunSummary& summary);
/// A few sentences for the person who ran it.
std::string in_words(const RunSummary& summary);
/// Writes a sibling and renames it, so that the file is whole or not there. Errors: it cannot be written.
Result<bool> write_summary(const std::filesystem::path& file, const RunSummary& summary);

/// The status as a list of words, e.g. {"time slipped"}.
std::vector<std::string> status_words(std::uint32_t status);
/// 12345 → "12 345".
std::string grouped(std::uint64_t number);

}  // namespace slosh
