// What the hands did and felt, on its way from the device loop to wrenches.csv and poses.csv.
#pragma once

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "peer/haptics/servo.h"
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
  bool write_failed() const { return failed_; }              ///< after stop(): the disk was full, say

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, CloseFile>;

  Recorder(Servo& servo, File wrenches, File poses);
  void drain();

  Servo& servo_;
  File wrenches_;
  File poses_;
  std::vector<Peak> peaks_;
  std::uint64_t rows_ = 0;
  bool failed_ = false;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace slosh
