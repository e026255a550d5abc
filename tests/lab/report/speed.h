// What a step costs over the size of the world: rows of the paper's Figure 6, shares of passes, a roofline.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/lab/report/passes.h"
#include "tests/lab/report/roofline.h"
#include "tests/lab/report/speed_pool.h"

namespace slosh::report {

/// The paper's rates: what a hand needs of a fluid's forces, and of a rigid body's. Hz.
inline constexpr double kFluidRate = 70.0;
inline constexpr double kRigidRate = 1000.0;
/// Particles that the paper steps at kFluidRate, on its GPU.
inline constexpr double kPaperParticles = 32000.0;
/// Of the paper's Figures 6b and 6c, fluid and bodies together.
inline constexpr std::size_t kPaperTotal = 25000;

/// A point of Figure 6.
struct SpeedRow {
  std::string figure;   ///< "6a", "6b", "6c"
  std::string backend;  ///< "cpu", "cuda"
  std::string device;   ///< in words
  std::size_t fluid_particles = 0;
  std::size_t body_particles = 0;  ///< of free bodies
  std::size_t wall_particles = 0;  ///< of the pool's walls
  int bodies = 0;                  ///< free ones
  double spacing = 0.0;            ///< m
  double step_ms = 0.0;            ///< median of World::step
  double step_p10_ms = 0.0;
  double step_p90_ms = 0.0;
  double picture_ms = 0.0;  ///< median of a picture, drawn and read back; 0: none was drawn
  double time_step = 0.0;   ///< s of simulated time that a step takes the world on by, all its sub-steps
  int sub_steps = 1;

  double particle_steps_per_s() const { return 1e3 * static_cast<double>(fluid_particles) / step_ms; }
  double real_time_factor() const { return 1e3 * time_step / step_ms; }
};
inline constexpr const char* kSpeedHeader =
    "figure,backend,device,fluid_particles,body_particles,wall_particles,bodies,spacing_m,step_ms,step_p10_"
    "ms,"
    "step_p90_ms,picture_ms,particle_steps_per_s,simulated_ms_a_step,sub_steps,real_time_factor";

/// What a pass takes of a step.
struct ShareRow {
  std::string figure;  ///< and the next three: as its SpeedRow has them
  std::string device;
  std::size_t fluid_particles = 0;
  int bodies = 0;
  std::string pass;
  double ms = 0.0;     ///< median
  double share = 0.0;  ///< of the step
};
inline constexpr const char* kShareHeader = "figure,device,fluid_particles,bodies,pass,ms,share";

/// A heavy pass of 6a's step beside the ceilings.
struct RoofRow {
  std::string device;
  std::size_t fluid_particles = 0;
  std::string pass;
  double ms = 0.0;  ///< median
  PairCounts pairs;
  double bytes = 0.0;  ///< that the pass must move in a step, at least
  double flops = 0.0;
  Ceilings ceilings;

  double bytes_per_s() const { return 1e3 * bytes / ms; }
  double flops_per_s() const { return 1e3 * flops / ms; }
  double flops_per_byte() const { return flops / bytes; }
  /// Of what the lower ceiling allows: 1 is as fast as can be.
  double share_of_roof() const;
};
inline constexpr const char* kRoofHeader =
    "device,fluid_particles,pass,ms,candidates,neighbours,bytes,flops,gb_per_s,gflop_per_s,flop_per_byte,"
    "memory_gb_per_s,fma_gflop_per_s,share_of_roof";

struct SpeedRows {
  std::vector<SpeedRow> speeds;
  std::vector<ShareRow> shares;
  std::vector<RoofRow> roofs;
};

std::string csv_line(const SpeedRow& row);
std::string csv_line(const ShareRow& row);
std::string csv_line(const RoofRow& row);
/// Appends a speed.csv's rows, and those of shares.csv and roofline.csv beside it where they are there.
/// Errors: as read_rows.
Result<bool> read_speeds(const std::filesystem::path& file, SpeedRows& rows);

/// A picture's time, ms, of a world that has just been stepped; nothing where none can be drawn.
using PictureTimer = std::function<double(const SpeedPool&, World&)>;

/// Steps a pool and appends its row, the shares and, of 6a where `ceilings` are known, the roofline. The
/// row's figure, backend and device are `begun`'s. Throws Refused, Stopped.
void measure_speed(SpeedRow begun, const SpeedPool& pool, const PassOptions& options,
                   const PictureTimer& picture, const Ceilings* ceilings, SpeedRows& rows);

}  // namespace slosh::report
