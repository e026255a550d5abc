// What the hands did and felt, on its way from the device loop to wrenches.csv and poses.csv.
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

/// The largest wrench that each hand felt.
struct Peak {
  double force = 0.0;   ///< N
  double torque = 0.0;  ///< N·m
};

/// Drains a servo's samples on a thread of its own, some twenty times a second, and flushes: what was written
/// stays written whatever happens next. Without a folder it only keeps the peaks.
class Recorder {
 public:
  /// `folder` may be empty; else it must exist. Errors: a file cannot be written.
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
  Recorder(Servo& servo, std::unique_ptr<Table> wrenches, std::unique_ptr<Table> poses);
  void drain();

  Servo& servo_;
  std::unique_ptr<Table> wrenches_;  // null without a folder, as the other
  std::unique_ptr<Table> poses_;
  std::vector<Peak> peaks_;
  std::uint64_t rows_ = 0;
  mutable std::mutex problem_mutex_;
  std::string problem_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace slosh
