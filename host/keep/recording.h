// A run on the disk: where it started and every input since, so that it can be run again, with hashes and
// body states that say whether it was the same.
//
// Twelve bytes that name the format, then chunks (chunk.h): head, scene, the state that a reset goes back to,
// the state that the recording starts from; then events in the order in which they happened, a full state now
// and then, and an end mark. Cut off anywhere, it is readable up to its last whole chunk, about a quarter of
// a second.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "host/keep/file.h"
#include "host/keep/hand_coder.h"
#include "host/tap.h"
#include "scenes/scene.h"

namespace slosh::keep {

struct RecordingOptions {
  std::filesystem::path file;
  std::string version;             ///< of the program
  std::string backend;             ///< "cpu", "cuda"
  double body_rate = 60.0;         ///< body states a simulated second
  std::uint64_t hash_ticks = 100;  ///< between two hashes, >= 1
  double state_seconds = 10.0;     ///< simulated s between two full states
  double chunk_seconds = 0.25;     ///< wall s that a cut-off recording loses at most
  double sync_seconds = 1.0;       ///< wall s between two times that all is brought to the disk
  /// Of events that may wait for the disk; more ends the recording. A full state waits beside them, and one
  /// that is due while another still waits is left out.
  std::size_t queue_bytes = 64 << 20;
};

/// Whether a recording can be begun there without anything being lost. Errors: the file has something in it.
Result<bool> check_unrecorded(const std::filesystem::path& file);

/// What a recording came to.
struct RecordingTotals {
  std::uint64_t steps = 0;
  std::uint64_t hashes = 0;
  std::uint64_t changes = 0;  ///< commands that were granted
  std::uint64_t states = 0;   ///< full ones, the first not counted
  std::string ended_early;    ///< why; empty = the run ended
};

struct RecordingReport {
  RecordingTotals totals;
  std::uint64_t bytes = 0;
  std::uint64_t input_bytes = 0;  ///< of the events, before packing: hands alone
  std::string problem;            ///< the disk failed: what is in the file stays readable
};

/// A tap that writes down what the host does, and a thread that packs and writes it: the host never waits for
/// the disk.
class RecordingWriter : public HostTap {
 public:
  /// Before the host starts. `start` is what a reset goes back to; of `state` the pause and the run count,
  /// the parameters are the world's own. Errors: the scene cannot be packed, the state is larger than a
  /// chunk, the file cannot be written.
  static Result<std::unique_ptr<RecordingWriter>> start(const Scene& scene, double spacing,
                                                        const Bytes& start, const World& world,
                                                        const HostState& state,
                                                        const RecordingOptions& options);
  ~RecordingWriter() override;
  /// After the host's end: waits until all is written.
  RecordingReport finish();
  /// Why the recording has ended before the run; empty = it goes on. As soon as it is known; any thread.
  std::string trouble() const;

  void before_step(const World& world, const StepInput& input) override;
  void after_step(const World& world) override;
  void after_change(const World& world, const HostCommand& change, const HostState& state) override;
  void on_end(const World& world) override;

 private:
  struct Waiting {
    std::uint8_t type = 0;
    Bytes content;
  };
  RecordingWriter(const Scene& scene, const RecordingOptions& options);
  void begin_events(const World& world);
  void flush_events();
  void add_bodies(const World& world);
  void add_hash(const World& world);
  void queue_events(Bytes content);
  /// False when one still waits.
  bool queue_state(const World& world);
  void end_early(const std::string& why);
  void queue_end();
  bool write(const Waiting& next, Bytes& packed, bool sync);
  void run();

  RecordingOptions options_;
  // The host's thread alone, up to finish().
  std::vector<std::size_t> free_bodies_;
  HandCoder hands_;
  Bytes events_;
  Bytes tick_;  // one tick's hands, used again
  BodySnapshot bodies_;
  std::int64_t events_since_ns_ = 0;
  double next_bodies_ = 0.0;
  double next_state_ = 0.0;
  std::uint32_t run_ = 0;
  bool hash_is_new_ = false;
  bool ended_ = false;
  RecordingTotals totals_;
  std::uint64_t input_bytes_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;  // of events, with those that are being written
  bool state_waits_ = false;       // or is being written
  std::string trouble_;
  bool stop_ = false;
  std::uint64_t bytes_ = 0;
  std::string problem_;
  File file_;
  std::thread thread_;
};

struct RecordingHead {
  Scene scene;
  double spacing = 0.0;    ///< m
  double time_step = 0.0;  ///< s
  std::string version;     ///< of the program that wrote it
  std::string backend;
  HostState state;  ///< the viscosities may be missing: hosts wrote none once, and the world has them
  Bytes start;      ///< World::save of what a reset goes back to
  Bytes world;      ///< World::save of where the recording starts
};

struct BodyRecord {
  std::uint32_t body = 0;
  Pose pose;    ///< of the mesh frame; rounded to float
  Twist twist;  ///< of the centre of mass; rounded to float
};

struct RecordingEvent {
  enum class Kind : std::uint8_t { kStep, kBodies, kHash, kChange, kState, kEnd };
  Kind kind = Kind::kStep;
  std::uint64_t tick = 0;          ///< of the world: after the step for kStep, else as it is
  std::uint32_t run = 0;           ///< counts resets
  std::vector<HandleInput> hands;  ///< kStep
  std::vector<BodyRecord> bodies;  ///< kBodies: the free ones
  std::uint64_t hash = 0;          ///< kHash
  HostCommand change;              ///< kChange
  Bytes state;                     ///< kState: World::save
  RecordingTotals totals;          ///< kEnd
};

/// Reads a recording from its start to its end, a chunk at a time.
class RecordingReader {
 public:
  /// Errors: it cannot be read, is no recording, is of another version, is damaged or cut off before its
  /// first state.
  static Result<std::unique_ptr<RecordingReader>> open(const std::filesystem::path& path);
  /// The file stays the caller's.
  static Result<std::unique_ptr<RecordingReader>> open(std::FILE* file, const std::string& name);

  const RecordingHead& head() const { return head_; }
  /// The next event, valid until the call after; null at the end (see complete()). Errors: damaged, and
  /// where.
  Result<const RecordingEvent*> next();
  /// After the end: whether the end mark was there; else the file is cut off.
  bool complete() const { return complete_; }

 private:
  explicit RecordingReader(std::FILE* file, std::string name)
      : name_(std::move(name)), chunks_(file), hands_(0) {}
  Result<bool> read_head();
  Result<bool> next_chunk();
  Result<bool> read_event();
  Error damaged(const std::string& what) const;

  File owned_;
  std::string name_;
  ChunkReader chunks_;
  Chunk chunk_;
  ByteView left_;  // of the events in chunk_
  HandCoder hands_;
  std::vector<std::uint32_t> free_bodies_;
  RecordingHead head_;
  RecordingEvent event_;
  std::uint64_t tick_ = 0;
  std::uint64_t steps_ = 0;
  std::uint32_t run_ = 0;
  bool complete_ = false;
  bool over_ = false;
};

}  // namespace slosh::keep
