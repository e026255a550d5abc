// A host's world on the disk, so that at most a second of it is lost when the host dies.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "host/keep/chunk.h"
#include "host/tap.h"
#include "scenes/scene.h"

namespace slosh::keep {

/// Everything that a host needs to carry on.
struct Checkpoint {
  Scene scene;
  double spacing = 0.0;  ///< m
  HostState state;       ///< `run` and `paused`; the parameters are in the world's state too
  std::uint64_t tick = 0;
  double time = 0.0;    ///< simulated s
  Bytes start;          ///< World::save of what a reset goes back to
  Bytes world;          ///< World::save
  Bytes session;        ///< the server's own: its key, links, seats
  std::string version;  ///< of the program that wrote it
  std::string note;     ///< when not empty: the file was damaged, and this is the one before it
};

struct CheckpointOptions {
  std::filesystem::path file;
  double interval = 0.5;  ///< s of wall time between two copies of the world
  std::string version;
  Bytes session;  ///< what the first file has, up to set_session(): that of the host that is resumed
};

struct CheckpointReport {
  std::uint64_t written = 0;
  std::uint64_t bytes = 0;   ///< of the last file
  double copy_ms = 0.0;      ///< longest copy, on the host's thread
  double write_ms = 0.0;     ///< longest writing, beside it
  double longest_gap = 0.0;  ///< s between the worlds of two files on end
  std::string problem;       ///< why the last one could not be written; empty = it was
};

/// A tap that copies the world now and then, and a thread that writes the copies. Made before the host
/// starts.
class CheckpointWriter : public HostTap {
 public:
  /// Writes a first file at once. `start` is what a reset goes back to. Errors: the scene cannot be packed,
  /// the file cannot be written.
  static Result<std::unique_ptr<CheckpointWriter>> start(const Scene& scene, double spacing, Bytes start,
                                                         const World& world, const HostState& state,
                                                         const CheckpointOptions& options);
  ~CheckpointWriter() override;

  /// What the session is from now on; written soon, also while the world stands still. Any thread.
  void set_session(Bytes session);
  /// Waits until everything up to now is on the disk. Any thread but the host's.
  void flush();
  CheckpointReport report() const;

  void after_step(const World& world) override;
  void after_change(const World& world, const HostCommand& change, const HostState& state) override;
  void on_end(const World& world) override;

 private:
  struct Copy {
    Bytes world;
    HostState state;
    std::uint64_t tick = 0;
    double time = 0.0;
    std::int64_t stamp_ns = 0;
  };
  explicit CheckpointWriter(const CheckpointOptions& options) : options_(options) {}
  void take_copy(const World& world);
  void run();
  Result<bool> write(const Copy& copy, const Bytes& session);

  CheckpointOptions options_;
  Bytes beginning_;  // of every file: scene and start, in chunks
  double spacing_ = 0.0;
  // The host's thread alone.
  HostState state_;
  std::int64_t last_copy_ns_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Copy waiting_;  // the newest, when there is one to write
  Bytes spare_;   // so that a copy need not allocate
  bool has_waiting_ = false;
  Bytes session_;
  bool session_changed_ = false;
  bool writing_ = false;
  bool stop_ = false;
  CheckpointReport report_;
  Copy last_;  // the writer's: what the last file has
  std::thread thread_;
};

/// Reads a checkpoint, or the one before it where `file` is damaged (then with a note). Errors: neither can
/// be read, with what is wrong with `file`.
Result<Checkpoint> read_checkpoint(const std::filesystem::path& file);
/// The same for one file alone.
Result<Checkpoint> read_checkpoint_file(std::FILE* file, const std::string& name);

}  // namespace slosh::keep
