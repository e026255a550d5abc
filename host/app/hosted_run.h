// One run of `slosh host`: the world, the network and the files, joined.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "host/app/host_world.h"
#include "host/host.h"
#include "host/keep/checkpoint.h"
#include "host/server/console_door.h"
#include "host/server/net_loop.h"
#include "host/server/snapshot_coder.h"
#include "host/task_tap.h"
#include "peer/app/world_files.h"

namespace slosh {

class SupervisorControl;

/// Whether the place that the options ask for, or the usual one, can be listened at now: else it would be
/// said when all is measured and settled. Where an earlier host listened is its checkpoint's to say.
Result<bool> can_host_there(const HostVerbOptions& options);

/// Made, started and ended by one thread.
class HostedRun {
 public:
  /// `hosted` must outlive it; its world is taken. Errors: the address cannot be listened at, a file cannot
  /// be written, the scene does not fit into a message. `supervision`: who looks after its pulses.
  static Result<std::unique_ptr<HostedRun>> create(HostedWorld& hosted, const HostVerbOptions& options,
                                                   SupervisorControl* supervision = nullptr);
  ~HostedRun();
  HostedRun(const HostedRun&) = delete;
  HostedRun& operator=(const HostedRun&) = delete;

  void start();
  /// Says goodbye to everybody, ends the world, completes the files.
  void stop(const std::string& why);

  Host& host() { return *host_; }
  const TaskTap* task() const { return task_tap_.get(); }  ///< null where the scene has none
  NetLoop& net() { return *net_; }
  ConsoleDoor& door() { return *door_; }
  const std::string& address() const { return address_; }
  const std::string& checkpoint_file() const { return checkpoint_file_; }
  /// Where the checkpoint of an earlier host went that was in its place; empty = there was none.
  const std::string& set_aside() const { return set_aside_; }
  const std::vector<LinkRecord>& first_links() const { return first_links_; }
  std::string text_of(const LinkRecord& link) const;
  /// What the run has to say since the last call, line by line.
  std::vector<std::string> news();
  /// What does not reach the disk, and why; empty = all is well.
  std::string trouble() const;
  /// Hands what changed in links and seats to the checkpoint; now and then.
  void save_server_state();
  const keep::CheckpointWriter* checkpoint() const { return checkpoint_.get(); }
  const WorldFiles& files() const { return *files_; }
  /// Whether the world stands until hands take hold (--wait).
  bool waits() const { return hosted_.waits; }
  double coding_seconds() const { return coding_seconds_; }

 private:
  HostedRun(HostedWorld& hosted, const HostVerbOptions& options) : hosted_(hosted), options_(options) {}
  Result<bool> open_network(SupervisorControl* supervision);
  std::string choose_checkpoint() const;
  Result<bool> open_files();
  void make_links();

  HostedWorld& hosted_;
  const HostVerbOptions& options_;
  Identity identity_ = Identity::generate();
  std::string address_;
  keep::HostPlace place_;
  std::string checkpoint_file_;
  std::string set_aside_;
  std::vector<std::string> reachable_;
  std::vector<LinkRecord> first_links_;
  std::mutex news_mutex_;
  std::vector<std::string> news_;
  wire::Bytes saved_state_;

  // In the order in which they are needed; ended in the opposite one.
  std::unique_ptr<Channel> channel_;
  SnapshotDemand demand_;
  FluidDemand fluid_demand_;
  SnapshotDesk desk_;
  std::unique_ptr<Server> server_;
  std::unique_ptr<Endpoint> endpoint_;
  std::unique_ptr<keep::CheckpointWriter> checkpoint_;
  std::unique_ptr<WorldFiles> files_;
  std::unique_ptr<TaskTap> task_tap_;  // null where the scene has no task
  std::unique_ptr<Host> host_;
  std::unique_ptr<SnapshotThread> snapshots_;
  std::unique_ptr<NetLoop> net_;
  std::unique_ptr<ConsoleDoor> door_;
  double coding_seconds_ = 0.0;
  bool stopped_ = false;
};

}  // namespace slosh
