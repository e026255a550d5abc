#include "peer/app/remote_run.h"

#include <algorithm>
#include <utility>

#include "net/clock.h"
#include "net/grip_start.h"
#include "peer/app/hand_trouble.h"
#include "peer/app/run_report.h"

namespace slosh {

RemoteRun::RemoteRun(const Stage& stage, RemoteVisit& visit, RemoteRunOptions options)
    : stage_(stage),
      visit_(visit),
      options_(std::move(options)),
      device_on_(stage.scene.grips.size(), false),
      spec_of_(stage.scene.grips.size()),
      spec_for_(stage.scene.grips.size()) {
  for (const Grip& grip : stage.scene.grips) grip_names_.push_back(grip.name);
}

Result<std::unique_ptr<LiveRun>> RemoteRun::create(const Stage& stage, RemoteVisit& visit,
                                                   RemoteRunOptions options) {
  std::unique_ptr<RemoteRun> run(new RemoteRun(stage, visit, std::move(options)));
  run->look_at_world();
  ServoOptions servo;
  servo.coupling = run->options_.coupling;
  const bool records = run->status_.welcome.role == wire::Role::kParticipant && !stage.scene.grips.empty();
  Result<std::unique_ptr<OwnHands>> hands = OwnHands::create(
      stage, {}, *visit.world().channel, servo, records ? stage.folder : std::filesystem::path());
  if (!hands) return hands.error();
  run->hands_ = std::move(hands.value());
  const Result<bool> followed = run->follow_grips();
  if (!followed) return followed.error();
  return std::unique_ptr<LiveRun>(std::move(run));
}

/// From now on simulated time counts.
void RemoteRun::look_at_world() {
  status_ = visit_.status();
  last_time_ = status_.world_time;
  last_run_ = status_.moment.run;
}

void RemoteRun::start() {
  start_ns_ = steady_now_ns();
  look_at_world();
  hands_->start();
}

void RemoteRun::stop() {
  if (stop_ns_ == 0) stop_ns_ = steady_now_ns();
  visit_.stop();
  if (hands_) hands_->stop();
}

bool RemoteRun::running() {
  return !stopping_ && status_.state != LinkState::kEnded && elapsed_ < stage_.seconds;
}

SnapshotPointer RemoteRun::newest_snapshot() {
  SnapshotPointer snapshot = visit_.world().maker->newest(steady_now_ns());
  if (snapshot) last_snapshot_ = snapshot;
  return snapshot;
}

HudFacts RemoteRun::facts(double picture_rate) const {
  HudFacts facts;
  facts.title = stage_.scene.name;
  facts.spacing = visit_.world().spacing;
  facts.fluid_particles = status_.welcome.particles;
  facts.shared = status_.welcome.role == wire::Role::kParticipant;
  facts.may_change = status_.rights.run;
  facts.picture_rate = picture_rate;
  facts.walls_hold = stage_.scene.model != ParticleModel::kPaper;
  return facts;
}

Rates RemoteRun::world_rates() {
  status_ = visit_.status();
  follow_time();
  hands_->follow_stiffness(status_.world.grip_stiffness);
  const Result<bool> followed = follow_grips();
  (void)followed;  // each trouble was told, and the grip let go
  follow_task();
  for (const std::string& notice : visit_.take_notices()) options_.tell(notice);
  Rates rates;
  rates.time = status_.world_time;
  rates.start = rates.time - elapsed_;
  rates.real_time = status_.state == LinkState::kLive ? status_.moment.rate : 0.0;
  rates.connection = connection_text(status_, visit_.world().maker->delay(), steady_now_ns());
  rates.people = people_text(status_, grip_names_);
  rates.task = status_.task;
  stage_.ghost_clock->follow(rates.task.done, rates.time);
  return rates;
}

/// Where a finished step of the task gives a hand of ours another tool, asks for that.
void RemoteRun::follow_task() {
  const std::vector<HandMove>& moves = status_.task.hands;
  hands_moved_ = std::min(hands_moved_, moves.size());  // a task that began anew asks anew
  for (; hands_moved_ < moves.size(); ++hands_moved_) {
    const HandMove& move = moves[hands_moved_];
    const bool ours = move.from < status_.held.size() && status_.held[move.from];
    if (!ours || move.to >= status_.held.size() || status_.held[move.to]) continue;
    spec_for_[move.to] = spec_of_[move.from];
    RemoteCommand command;
    command.grip = move.from;
    command.take = false;
    visit_.ask(command);
    command.grip = move.to;
    command.take = true;
    visit_.ask(command);
  }
}

/// Simulated time that has passed for this person, whatever the world's own did in between. The world's time
/// is carried on from its newest update and falls back when that was too far: only what is beyond the
/// furthest counts, else a host that is slow and uneven would seem to run many times as long as it did.
void RemoteRun::follow_time() {
  if (!status_.moment.known) return;
  if (status_.moment.run != last_run_) {
    last_run_ = status_.moment.run;
    last_time_ = status_.world_time;
  }
  if (status_.world_time <= last_time_) return;
  elapsed_ += status_.world_time - last_time_;
  last_time_ = status_.world_time;
}

/// A device for each grip that is ours, none for the others.
Result<bool> RemoteRun::follow_grips() {
  const std::vector<std::string>& specs = options_.devices;
  for (std::size_t i = 0; i < device_on_.size(); ++i) {
    const bool held = i < status_.held.size() && status_.held[i];
    if (held == device_on_[i]) continue;
    device_on_[i] = held;
    if (!held) {
      hands_->set(i, {});
      continue;
    }
    std::string spec = std::exchange(spec_for_[i], {});
    if (spec.empty()) {
      spec = specs.empty() ? "script" : specs[std::min(grips_taken_, specs.size() - 1)];
      grips_taken_ += 1;
    }
    spec_of_[i] = spec;
    Result<HandDevice> made = hand_for(i, spec);
    if (!made) {
      options_.tell("slosh: " + made.error().text());
      RemoteCommand let_go;
      let_go.grip = static_cast<std::uint32_t>(i);
      let_go.take = false;
      visit_.ask(let_go);
      return made.error();
    }
    for (const std::string& note : hand_notes(stage_.scene, i, *made.value().device))
      options_.tell("slosh: " + note);
    hands_->set(i, std::move(made.value()));
  }
  return true;
}

/// An open device that holds on where the grip is now.
Result<HandDevice> RemoteRun::hand_for(std::size_t grip, const std::string& spec) const {
  Pose start = grip_start(stage_.scene, grip);
  if (last_snapshot_ && grip < last_snapshot_->rigid.grips.size())
    start = last_snapshot_->rigid.grips[grip].pose;
  Result<HandDevice> made =
      make_device(stage_.scene, grip, spec, start, options_.has_window, options_.controllers);
  if (!made) return made;
  if (const Result<bool> opened = open_device(*made.value().device); !opened) return opened.error();
  return made;
}

LiveValues RemoteRun::live_values() const {
  LiveValues values;
  values.may_change = status_.rights.parameters;
  values.gravity_scale = status_.world.gravity_scale;
  values.viscosities = status_.world.viscosities;
  values.grips = hands_->live_grips(status_.world.grip_stiffness);
  for (std::size_t i = 0; i < values.grips.size(); ++i)
    values.grips[i].may_set = may_set_stiffness(status_, i);
  return values;
}

PeerLine RemoteRun::understand(const std::string& line) {
  return peer_line(line, visit_.status(), stage_.scene, visit_.world().maker->delay(), steady_now_ns());
}

void RemoteRun::report(RunSummary& s) const {
  const RemoteStatus status = visit_.status();
  const LinkNumbers& numbers = status.numbers;
  const SnapshotReport shown = visit_.world().maker->report();
  report_stage(stage_, s);
  report_time(elapsed_, to_seconds(stop_ns_ - start_ns_), s);
  hands_->report(s);
  s.spacing = visit_.world().spacing;
  s.spacing_reason = "the host's";
  s.fluid_particles = status.welcome.particles;
  s.time_step = status.welcome.time_step;
  s.backend = "the host's";
  if (!stage_.folder.empty() && !s.devices.empty()) s.files = {"wrenches.csv", "poses.csv"};

  NetworkSummary n;
  n.host = options_.host;
  n.name = status.welcome.name;
  n.participant = status.welcome.role == wire::Role::kParticipant;
  n.round_trip = numbers.round_trip;
  n.send_loss = numbers.send_loss;
  n.clock_error = numbers.clock_error;
  n.hand_delay = numbers.body_delay;
  n.picture_delay = shown.delay;
  n.age_ms = spread_of(shown.age, 1e3);
  n.bytes_received = numbers.bytes_received;
  n.bytes_sent = numbers.bytes_sent;
  n.seconds = to_seconds(stop_ns_ - options_.begin_ns);
  n.poses_sent = numbers.poses;
  n.states = numbers.bodies.states;
  n.states_incomplete = numbers.bodies.incomplete;
  n.snapshots = shown.frames;
  n.snapshots_partial = shown.frames - shown.whole;
  n.pieces_refused = shown.refused;
  n.datagrams_refused = numbers.bad_datagrams;
  n.reconnects = numbers.reconnects;
  n.to_live = to_seconds(status.live_ns - options_.begin_ns);
  n.to_first_picture = shown.first_shown_ns == 0 ? 0.0 : to_seconds(shown.first_shown_ns - options_.begin_ns);
  n.first_picture_time = shown.first_shown_time;
  n.last_picture_time = shown.last_shown_time;
  n.ended = status.error ? status.error->text() : status.farewell;
  s.network = n;
}

}  // namespace slosh
