// What a run amounted to: summary.json, and the same in words.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "peer/output/machine.h"
#include "peer/output/measured.h"
#include "peer/output/score.h"
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
  double clipped = 0.0;      ///< s in which more was asked of the device than it gives
  double mean_force = 0.0;   ///< N, while it felt any; 0 = not known
};

/// A step of a guided task.
struct TaskStepSummary {
  std::string say;
  bool done = false;
  bool late = false;                    ///< done, after its time
  double took = 0.0;                    ///< s
  std::vector<std::string> measured{};  ///< what its goal measures, as it was met: "fluid in pan 0.21 kg"
};

/// What the network was like for a peer of somebody else's world.
struct NetworkSummary {
  std::string host;  ///< address
  std::string name;  ///< ours, as the others saw it
  bool participant = false;
  double round_trip = 0.0;     ///< s
  double send_loss = 0.0;      ///< share of our datagrams
  double clock_error = 0.0;    ///< s, bound
  double hand_delay = 0.0;     ///< s that the device loop lived behind the host
  double picture_delay = 0.0;  ///< s that pictures were behind it, at the end
  Spread age_ms;               ///< of what was shown, behind the host's world
  std::uint64_t bytes_received = 0;
  std::uint64_t bytes_sent = 0;
  double seconds = 0.0;          ///< of wall time that these bytes took
  std::uint64_t poses_sent = 0;  ///< distinct samples
  std::uint64_t states = 0;      ///< body states used
  std::uint64_t states_incomplete = 0;
  std::uint64_t snapshots = 0;
  std::uint64_t snapshots_partial = 0;
  std::uint64_t pieces_refused = 0;
  std::uint64_t datagrams_refused = 0;
  std::uint64_t reconnects = 0;
  double to_live = 0.0;                                      ///< s from the program's start until bodies came
  double to_first_picture = 0.0;                             ///< s from the program's start; 0 = no picture
  double first_picture_time = 0.0, last_picture_time = 0.0;  ///< simulated s
  std::string ended;                                         ///< the host's last words, or ours
};

/// Plain numbers, filled from the host's and the peer's reports.
struct RunSummary {
  std::string scene;
  std::string scene_file;
  double spacing = 0.0;  ///< m
  std::string spacing_reason;
  std::size_t fluid_particles = 0;
  std::size_t boundary_particles = 0;
  std::uint64_t retired_particles = 0;    ///< out of the world: spilled over the domain's edge, or lost
  std::uint64_t lost_particles = 0;       ///< of these, as Diagnostics::lost
  std::uint64_t retired_settling = 0;     ///< as retired_particles, before the run: while the world settled
  std::uint64_t lost_settling = 0;        ///< of these, as Diagnostics::lost
  bool walls_hold = true;                 ///< Plan::walls_hold
  std::uint64_t particles_in_solids = 0;  ///< at the end
  std::uint64_t steps = 0;
  double time_step = 0.0;         ///< s
  double simulated = 0.0;         ///< s
  double wall = 0.0;              ///< s of the run itself
  double real_time_factor = 0.0;  ///< simulated over wall
  Spread step_ms;
  std::vector<std::pair<std::string, double>> step_share;  ///< of the step, 0–1, by pass
  Spread device_loop_us;                                   ///< period, wake to wake
  std::uint64_t device_ticks = 0;
  std::uint64_t device_missed = 0;
  std::string device_scheduler;
  bool device_memory_locked = false;
  bool rendered = false;
  std::string renderer;
  bool fast_picture = false;  ///< Quality::kFast
  int width = 0, height = 0;
  std::uint64_t frames = 0;
  std::uint64_t frames_dropped = 0;
  Spread frame_ms;
  std::uint32_t status = 0;  ///< StatusBits
  std::array<std::uint64_t, 32>
      status_steps{};             ///< in how many steps each was set; 0 where that is not known
  std::vector<std::string> gone;  ///< bodies that left the world for good, in words
  std::uint64_t slips = 0;
  double slipped = 0.0;  ///< s
  std::uint64_t rejected_poses = 0;
  std::uint64_t samples_lost = 0;
  double fluid_mass_start = 0.0;  ///< kg, of the run: after settling
  bool fluid_came = false;        ///< some appeared, or was taken away, while it ran
  double fluid_mass_end = 0.0;    ///< kg still in the world
  MeasuredRun measured;
  std::vector<DeviceSummary> devices;
  std::vector<TaskStepSummary> task;  ///< all of its steps; empty where the scene has none
  double spilled_mass = 0.0;          ///< kg, with a task: in no region of the scene at the end, or out of it
  std::vector<Score> scores{};        ///< the last runs of the scene, this one behind; empty without --score
  std::string backend;
  int threads = 1;
  Machine machine;
  std::string version;
  bool interrupted = false;
  std::uint64_t export_frames = 0;    ///< written for other programs
  std::uint64_t export_left_out = 0;  ///< what came faster than it could be written
  double export_seconds = 0.0;        ///< of wall time that packing and writing took
  std::string recording;              ///< file that the run was recorded to; empty = none
  std::string recording_problem;      ///< why it is not whole; empty = it is
  std::string verdict;                ///< of a replay: whether it came out as it was recorded; empty = none
  std::vector<std::string> files;     ///< written, summary.json included
  std::vector<std::string> problems;  ///< what could not be written, or not to its end; empty = all is whole
  std::string folder;
  std::optional<NetworkSummary> network;  ///< set when the world was elsewhere
};

nlohmann::ordered_json to_json(const RunSummary& summary);
/// A few sentences for the person who ran it.
std::string in_words(const RunSummary& summary);
/// Writes a sibling and renames it, so that the file is whole or not there. Errors: it cannot be written.
Result<bool> write_summary(const std::filesystem::path& file, const RunSummary& summary);

/// The status as a list of words, e.g. {"time slipped"}.
std::vector<std::string> status_words(std::uint32_t status);
/// The same with the numbers that the run has of each, e.g. {"fluid left the domain and is out of the world
/// (264 of 344, in 12 of 1 714 steps)"}.
std::vector<std::string> status_words(const RunSummary& summary);
/// 12345 → "12 345".
std::string grouped(std::uint64_t number);

}  // namespace slosh
