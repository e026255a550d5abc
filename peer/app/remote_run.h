// A run of somebody else's world: the peer's own parts around a RemoteVisit.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "peer/app/live_run.h"
#include "peer/app/prepare.h"
#include "peer/remote/remote_visit.h"

namespace slosh {

struct RemoteRunOptions {
  std::vector<std::string> devices;  ///< none (script), one for all, or one for each grip in order of taking
  Coupling coupling = Coupling::kReplica;
  bool has_window = false;
  std::shared_ptr<HeadsetLink> controllers;      ///< null without a headset
  std::string host;                              ///< address, for the summary
  std::int64_t begin_ns = 0;                     ///< when the program began
  std::function<void(const std::string&)> tell;  ///< a line for the person
};

class RemoteRun final : public LiveRun {
 public:
  /// `stage` and `visit`, which is live, must outlive it. Errors: a file cannot be written, a device of a
  /// grip that is held already cannot be used.
  static Result<std::unique_ptr<LiveRun>> create(const Stage& stage, RemoteVisit& visit,
                                                 RemoteRunOptions options);
  ~RemoteRun() override { stop(); }

  void start() override;
  void request_stop() override { stopping_ = true; }
  bool running() override;
  void stop() override;
  SnapshotQueue& snapshots() override { return visit_.world().channel->snapshots(); }
  SnapshotPointer newest_snapshot() override;
  HudFacts facts(double picture_rate) const override;
  bool paused() const override { return status_.world.paused; }
  bool hears() const override { return true; }
  LiveValues live_values() const override;
  void report(RunSummary& summary) const override;

 private:
  RemoteRun(const Stage& stage, RemoteVisit& visit, RemoteRunOptions options);
  OwnHands* hands() const override { return hands_.get(); }
  Rates world_rates() override;
  PeerLine understand(const std::string& line) override;
  void ask(const RemoteCommand& command, bool) override { visit_.ask(command); }
  void look_at_world();
  void follow_time();
  Result<bool> follow_grips();
  void follow_task();
  Result<HandDevice> hand_for(std::size_t grip, const std::string& spec) const;

  const Stage& stage_;
  RemoteVisit& visit_;
  RemoteRunOptions options_;
  RemoteStatus status_;
  std::unique_ptr<OwnHands> hands_;
  std::vector<bool> device_on_;        // grips that have a device now
  std::size_t grips_taken_ = 0;        // ever
  std::vector<std::string> spec_of_;   // one a grip: what its device was made by
  std::vector<std::string> spec_for_;  // one a grip: of the hand that is on its way to it
  std::size_t hands_moved_ = 0;        // of the task's
  SnapshotPointer last_snapshot_;
  std::vector<std::string> grip_names_;
  double elapsed_ = 0.0;    // simulated s since the start
  double last_time_ = 0.0;  // simulated s, the furthest of this run
  std::uint32_t last_run_ = 0;
  std::int64_t start_ns_ = 0;
  std::int64_t stop_ns_ = 0;
  bool stopping_ = false;
};

}  // namespace slosh
