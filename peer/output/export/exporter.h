// Frames of a run for other programs: packed and written by a thread of their own.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "peer/output/export/export_options.h"
#include "peer/output/export/particle_frame.h"
#include "peer/output/table.h"
#include "sim/math/result.h"

namespace slosh {

struct ExportOptions {
  std::vector<ExportKind> kinds;  ///< at least one
  double rate = 30.0;             ///< frames a simulated second, > 0
  /// Whoever steps the world waits when frames come faster than they are written. Else those frames are left
  /// out and counted: a world that people feel does not wait.
  bool waits = false;
  int threads = 1;  ///< of OpenVDB's own
};

struct ExportReport {
  std::uint64_t frames = 0;    ///< written
  std::uint64_t left_out = 0;  ///< no room to keep them in
  double seconds = 0.0;        ///< of wall time that packing and writing took
};

/// What frames.csv begins with. A row a frame that is whole; volumes are all fluids' together, the surface's
/// empty where none was asked for.
constexpr const char* kFramesHeader = "frame,time_s,particles,particle_volume_m3,surface_volume_m3";

/// Writes FOLDER/frames/particles_00000.ply and so on, frames.csv with the time of each, and particles.pvd
/// (for ParaView) where there are VTU files. Each file is whole or not there. After the first one that cannot
/// be written nothing more is.
class Exporter {
 public:
  /// Errors: the folder cannot be made or written to.
  static Result<std::unique_ptr<Exporter>> create(const ExportedFluids& fluids, const ExportOptions& options,
                                                  const std::filesystem::path& folder);
  ~Exporter();
  Exporter(const Exporter&) = delete;
  Exporter& operator=(const Exporter&) = delete;

  /// Whether a frame is due at `time` (simulated s since the run began), within a rounding. `time` never
  /// falls.
  bool due(double time) const;
  /// Takes a frame that is due; its number is set here, from its time: number n is of n / rate, so what is
  /// left out, or falls between two steps, leaves a gap. One thread calls due() and this.
  void add(ParticleFrame frame);
  /// Writes what waits and ends; nothing is taken any more.
  void stop();

  ExportReport report() const;
  /// Frames that wait to be written; any thread.
  std::size_t waiting() const;
  /// Why frames end early, or that some are missing; empty while all is well; any thread.
  std::string problem() const;
  /// In the run's folder, for the summary, e.g. "frames/particles_*.ply".
  std::vector<std::string> files() const;

 private:
  Exporter(const ExportedFluids& fluids, const ExportOptions& options, std::filesystem::path folder)
      : fluids_(fluids), options_(options), folder_(std::move(folder)) {}
  void run();
  void write(const ParticleFrame& frame);
  Result<bool> write_files(const ParticleFrame& frame, double& surface_volume);
  std::filesystem::path file_of(ExportKind kind, std::uint64_t number) const;

  const ExportedFluids fluids_;
  const ExportOptions options_;
  const std::filesystem::path folder_;
  std::uint64_t next_ = 0;        // the frame that is due next; who adds knows
  std::unique_ptr<Table> table_;  // these three are the thread's
  std::vector<std::string> vtu_files_;
  std::vector<double> vtu_times_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<ParticleFrame> queue_;
  std::size_t queued_bytes_ = 0;
  bool stopping_ = false;
  ExportReport report_;
  std::string problem_;
  std::thread thread_;
};

}  // namespace slosh
