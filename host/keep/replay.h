// A recording run again, and whether it came out the same.
#pragma once

#include <memory>

#include "host/keep/recording.h"
#include "sim/backend.h"

namespace slosh::keep {

struct ReplayOptions {
  int threads = 0;                   ///< of the CPU backend; 0 = all cores
  Backend backend = Backend::kAuto;  ///< kAuto: the recording's, where it is there, else the CPU
  int gpu = 0;                       ///< of the CUDA backend
};

struct ReplayVerdict {
  bool hashes_comparable = true;  ///< on the backend that it was recorded on
  std::uint64_t hashes = 0;       ///< compared
  std::uint64_t agree = 0;
  std::uint64_t first_difference = 0;  ///< tick; when agree < hashes
  std::uint64_t bodies = 0;            ///< states of bodies compared
  double farthest = 0.0;               ///< m, a body's mesh frame from where it was recorded
  double largest_turn = 0.0;           ///< rad
  std::uint64_t steps = 0;
  std::uint64_t resets = 0;
  bool at_end = false;      ///< everything was read
  bool complete = false;    ///< and the end mark was there: not cut off
  std::string ended_early;  ///< why the recording was, in its own words

  /// The hashes agree; or, where they cannot be compared, every body stayed within a spacing and 0.1 rad.
  bool same(double spacing) const;
  /// "84 of 84 hashes agree", or what differs; and how the recording ended when that is not how it should.
  std::string text(double spacing) const;
};

/// One thread.
class Replayer {
 public:
  /// Opens, samples, restores. Errors: not a recording, not restorable here, the backend is not there.
  static Result<std::unique_ptr<Replayer>> open(const std::filesystem::path& file,
                                                const ReplayOptions& options);

  /// Everything up to and with the next step; false when there is none. Errors: the recording is damaged,
  /// with where. verdict() tells how far it came in any case.
  Result<bool> step();

  const RecordingHead& head() const { return reader_->head(); }
  const SampledScene& sampled() const { return sampled_; }
  const World& world() const { return world_; }
  Backend backend() const { return backend_; }
  double elapsed() const;  ///< simulated s since the recording's start, over all resets
  std::uint32_t status() const { return status_; }  ///< StatusBits that were ever set
  const ReplayVerdict& verdict() const { return verdict_; }

 private:
  Replayer(std::unique_ptr<RecordingReader> reader, SampledScene sampled, World world, Backend backend)
      : reader_(std::move(reader)),
        sampled_(std::move(sampled)),
        world_(std::move(world)),
        backend_(backend) {}
  Result<bool> change(const HostCommand& command);
  void compare_bodies(const std::vector<BodyRecord>& recorded);
  void compare_hash(std::uint64_t recorded);

  std::unique_ptr<RecordingReader> reader_;
  SampledScene sampled_;
  World world_;
  Backend backend_;
  BodySnapshot now_;
  ReplayVerdict verdict_;
  std::uint32_t status_ = 0;
};

}  // namespace slosh::keep
