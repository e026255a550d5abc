// A host's world on the disk, so that at most a second of it is lost when the host dies.
//
// Eight bytes that name the format, then chunks (chunk.h): scene, the state that a reset goes back to, head,
// the world's state, end mark. No secret is in it: the host's key and its links are beside it (secrets.h).
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "host/keep/chunk.h"
#include "host/keep/file.h"
#include "host/tap.h"
#include "scenes/scene.h"

namespace slosh::keep {

/// Where a host is reached, so that it is there again when it carries on.
struct HostPlace {
  std::string listen;                  ///< ADDR:PORT as it was bound; empty = not known
  std::vector<std::string> addresses;  ///< what its links were told to carry; empty = what the machine has
};

/// Everything that a host needs to carry on.
struct Checkpoint {
  Scene scene;
  double spacing = 0.0;  ///< m
  HostState state;       ///< `run` and `paused`; the parameters are in the world's state too
  std::uint64_t tick = 0;
  double time = 0.0;  ///< simulated s
  Bytes start;        ///< World::save of what a reset goes back to
  Bytes world;        ///< World::save
  HostPlace place;
  std::uint64_t run = 0;  ///< the same as in the secrets that belong to it
  std::string version;    ///< of the program that wrote it
  std::string note;  ///< when not empty: the file was damaged, this is the one before it, and what that loses
};

struct CheckpointOptions {
  std::filesystem::path file;
  double interval = 0.5;  ///< s of wall time between two copies of the world
  std::string version;
  HostPlace place;
  std::uint64_t run = 0;
  std::function<std::vector<double>()> task_done{};  ///< HostState::task_done as it is; may be empty
  Bytes
      server_state;  ///< the secrets beside the first file, up to set_server_state(); empty: none are written
};

struct CheckpointReport {
  std::uint64_t written = 0;
  std::uint64_t copies = 0;  ///< of the whole world
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
  /// Writes the secrets and a first file at once. `start` is what a reset goes back to. A file that is there
  /// stays as the one before it, unless it is damaged. Errors: the scene cannot be packed, the state is
  /// larger than a chunk, a file cannot be written.
  static Result<std::unique_ptr<CheckpointWriter>> start(const Scene& scene, double spacing, Bytes start,
                                                         const World& world, const HostState& state,
                                                         const CheckpointOptions& options);
  ~CheckpointWriter() override;

  /// The server's state from now on; its secrets are written soon, also while the world stands still. Any
  /// thread.
  void set_server_state(Bytes server_state);
  /// Waits until everything up to now is on the disk. Any thread but the host's.
  void flush();
  CheckpointReport report() const;

  void after_step(const World& world) override;
  void while_standing(const World& world) override;
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
  bool due() const;
  void run();
  Result<bool> write(const Copy& copy, Replaced old);

  CheckpointOptions options_;
  Bytes beginning_;  // of every file: scene and start, in chunks
  double spacing_ = 0.0;
  // The host's thread alone.
  HostState state_;
  bool changed_since_copy_ = false;
  std::int64_t last_copy_ns_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Copy waiting_;  // the newest, when there is one to write
  Bytes spare_;   // so that a copy need not allocate
  bool has_waiting_ = false;
  Bytes server_state_;
  bool server_state_changed_ = false;
  bool writing_ = false;
  bool stop_ = false;
  CheckpointReport report_;
  Copy last_;  // the writer's: what the last file has
  std::thread thread_;
};

/// Reads a checkpoint, or the one before it where `file` is damaged or missing (then with a note). Errors:
/// neither can be read, with what is wrong with `file`.
Result<Checkpoint> read_checkpoint(const std::filesystem::path& file);
/// The same for one file alone.
Result<Checkpoint> read_checkpoint_file(std::FILE* file, const std::string& name);

/// Makes room for another host's checkpoint: `file`, the one before it and their secrets are from now on
/// "FILE.1" (or the next number that is free), from where they can be resumed. Gives that name, or an empty
/// one when nothing was there. Errors: they cannot be moved.
Result<std::filesystem::path> set_checkpoint_aside(const std::filesystem::path& file);

}  // namespace slosh::keep
