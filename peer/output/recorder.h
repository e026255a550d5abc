// What the hands did and felt, on its way from the device loop to wrenches.csv, poses.csv and signals.csv.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "peer/haptics/servo.h"
#include "peer/output/table.h"
#include "sim/math/result.h"

namespace slosh {

constexpr const char* kWrenchesHeader = "time_s,device,fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm";

/// The largest wrench that each hand felt, and its mean force.
struct Peak {
  double force = 0.0;       ///< N
  double torque = 0.0;      ///< N·m
  double mean_force = 0.0;  ///< N, over the samples in which it felt any
  std::uint64_t felt = 0;   ///< of these, how many
};

/// Drains a servo's samples on a thread of its own, some twenty times a second, and flushes: what was written
/// stays written whatever happens next. Without a folder it only keeps the peaks.
class Recorder {
 public:
  /// `folder` may be empty; else it must exist. signals.csv is written where the servo keeps signals. Errors:
  /// a file cannot be written.
  static Result<std::unique_ptr<Recorder>> start(Servo& servo, const std::filesystem::path& folder);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Takes what is left and closes the files. After the device loop has stopped.
  void stop();
  const std::vector<Peak>& peaks() const { return peaks_; }  ///< after stop(), one a device
  std::uint64_t rows() const { return rows_; }               ///< after stop()
  /// Which table has ended early and why; empty while none has. At any time, from any thread.
  std::string problem() const;

 private:
  explicit Recorder(Servo& servo) : servo_(servo), peaks_(servo.devices()) {}
  void run();
  void drain();
  void drain_signals();
  void note_problems();

  Servo& servo_;
  std::unique_ptr<Table> wrenches_;  // null without a folder, as the other
  std::unique_ptr<Table> poses_;
  std::unique_ptr<Table> signals_;  // and where the servo keeps none
  std::vector<Peak> peaks_;
  std::uint64_t rows_ = 0;
  mutable std::mutex problem_mutex_;
  std::string problem_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace slosh
