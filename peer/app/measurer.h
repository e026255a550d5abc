// A run's instruments: bodies.csv and probes.csv, and what they amount to.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "peer/output/later_table.h"
#include "peer/output/measured.h"
#include "sim/instruments.h"

namespace slosh {

/// Simulated s between rows where a scene asks for instruments and nobody said how often.
constexpr double kMeasureInterval = 0.01;

/// What bodies.csv begins with. A wrench is the mean over the steps since the row before.
constexpr const char* kBodiesHeader =
    "time_s,body,x_m,y_m,z_m,qw,qx,qy,qz,cx_m,cy_m,cz_m,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s,"
    "fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm,fluid_inside";
/// What probes.csv begins with, before the columns of each gauge (NAME_level_m, NAME_pressure_pa) and
/// region (NAME_mass_kg).
constexpr const char* kProbesHeader =
    "time_s,particles,spilled,lost,in_solids,mass_kg,cx_m,cy_m,cz_m,px_kg_m_s,py_kg_m_s,pz_kg_m_s,kinetic_j";

/// True where the scene has a measured body, a gauge, a region or a joint.
bool asks_to_be_measured(const Scene& scene);

/// Told of every step on the thread that steps. Each wrench and motor is summed from step to step; all else
/// is looked at once a row. Bodies are those that are measured, and where the scene asks for nothing, those
/// that are free.
class Measurer {
 public:
  /// `interval` > 0, simulated s. Errors: a file cannot be written.
  static Result<std::unique_ptr<Measurer>> create(const Scene& scene, const SampledScene& sampled,
                                                  const std::filesystem::path& folder, double interval);

  /// The world before the first step.
  void begin(const World& world, double elapsed);
  /// After each step; `elapsed`: simulated s since the run began, over all resets.
  void step(const World& world, double elapsed);
  /// Writes what is left. After the last step.
  void stop();

  MeasuredRun report() const;                             ///< after stop()
  std::uint64_t in_solids() const { return in_solids_; }  ///< in the last row
  std::string problem() const;                            ///< why a file ends early; any thread

 private:
  Measurer(const Scene& scene, const SampledScene& sampled, double interval);
  void write_rows(const World& world, double elapsed);

  struct Followed {
    int index = 0;
    MeasuredBody so_far;
    Wrench since_row;  // sums over steps
    Wrench since_start;
  };
  Instruments instruments_;
  double interval_;
  double next_ = 0.0;
  std::uint64_t steps_ = 0;  // since the row before
  std::uint64_t all_steps_ = 0;
  std::uint64_t rows_ = 0;
  std::uint64_t in_solids_ = 0;
  std::vector<Followed> bodies_;
  std::vector<MeasuredPlace> levels_;
  std::vector<MeasuredPlace> masses_;
  std::vector<double> motors_;       // a joint's, summed over steps since the row before
  std::vector<double> pulls_;        // N, a joint's largest reaction of any of these steps
  std::vector<double> twists_;       // N·m, likewise
  std::vector<char> joint_follows_;  // bits of kJointMoves and kJointPulls: the columns that a joint has
  Diagnostics last_;
  BodySnapshot now_;
  std::unique_ptr<LaterTable> body_table_;  // null where no body is followed
  std::unique_ptr<LaterTable> probe_table_;
};

}  // namespace slosh
