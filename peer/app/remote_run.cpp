#include "peer/app/remote_run.h"

#include <algorithm>

#include "net/clock.h"
#include "net/grip_start.h"
#include "peer/app/live_grips.h"
#include "peer/app/run_report.h"
#include "peer/remote/peer_console.h"

namespace slosh {

RemoteRun::RemoteRun(const Stage& stage, RemoteVisit& visit, RemoteRunOptions options)
    : stage_(stage),
      visit_(visit),
      options_(std::move(options)),
      mice_(stage.scene.grips.size()),
      lent_(stage.scene.grips.size()),
      device_on_(stage.scene.grips.size(), false) {
  for (const Grip& grip : stage.scene.grips) grip_names_.push_back(grip.name);
}

Result<std::unique_ptr<RemoteRun>> RemoteRun::create(const Stage& stage, RemoteVisit& visit,
                                                     RemoteRunOptions options) {
  std::unique_ptr<RemoteRun> run(new RemoteRun(stage, visit, std::move(options)));
  run->status_ = visit.status();
  run->last_time_ = run->status_.world_time;
  run->last_run_ = run->status_.moment.run;
  ServoOptions servo;
  servo.coupling = run->options_.coupling;
  servo.sample_interval = 1.0 / stage.row_rate;
  servo.signals = stage.signals;
  run->servo_ = std::make_unique<Servo>(stage.scene, std::vector<std::unique_ptr<Device>>{},
                                        *visit.world().channel, servo);
  run->loop_ = std::make_unique<DeviceLoop>(*run->servo_);
  const bool records = run->status_.welcome.role == wire::Role::kParticipant && !stage.scene.grips.empty();
  Result<std::unique_ptr<Recorder>> recorder =
      Recorder::start(*run->servo_, records ? stage.folder : std::filesystem::path());
  if (!recorder) return recorder.error();
  run->recorder_ = std::move(recorder.value());
  const Result<bool> followed = run->follow_grips();
  if (!followed) return followed.error();
  return run;
}

RemoteRun::~RemoteRun() {
  stop();
}

void RemoteRun::start() {
  start_ns_ = steady_now_ns();
  status_ = visit_.status();
  last_time_ = status_.world_time;
  last_run_ = status_.moment.run;
  loop_->start();
}

void RemoteRun::stop() {
  if (stop_ns_ == 0) stop_ns_ = steady_now_ns();
  visit_.stop();
  if (loop_) loop_->stop();
  if (servo_) servo_->close_devices();
  if (recorder_) recorder_->stop();
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

Rates RemoteRun::note_rates() {
  status_ = visit_.status();
  follow_time();
  follow_stiffness(status_.world.grip_stiffness, *servo_);
  const Result<bool> followed = follow_grips();
  (void)followed;  // each trouble was told, and the grip let go
  for (const std::string& notice : visit_.take_notices()) options_.tell(notice);
  Rates rates;
  rates.time = status_.world_time;
  rates.start = rates.time - elapsed_;
  rates.real_time = status_.state == LinkState::kLive ? status_.moment.rate : 0.0;
  rates.device_rate = servo_->holds_any() ? loop_->rate() : 0.0;
  rates.device_status = servo_->status();
  rates.budgets = budget_lines(*servo_, stage_.scene);
  rates.connection = connection_text(status_, visit_.world().maker->delay(), steady_now_ns());
  rates.people = people_text(status_, grip_names_);
  rates_.add(rates);
  return rates;
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
    mice_[i].reset();
    lent_[i].reset();
    if (!held) {
      (void)servo_->set_device(i, nullptr);
      continue;
    }
    const std::string spec = specs.empty() ? "script" : specs[std::min(grips_taken_, specs.size() - 1)];
    grips_taken_ += 1;
    Pose start = grip_start(stage_.scene, i);
    if (last_snapshot_ && i < last_snapshot_->rigid.grips.size()) start = last_snapshot_->rigid.grips[i].pose;
    Result<HandDevice> made =
        make_device(stage_.scene, i, spec, start, options_.has_window, options_.controllers);
    if (made) {
      const Result<bool> opened = open_device(*made.value().device);
      if (!opened) made = opened.error();
    }
    if (!made) {
      let_go(i, made.error());
      return made.error();
    }
    for (const std::string& note : hand_notes(stage_.scene, i, *made.value().device))
      options_.tell("slosh: " + note);
    mice_[i] = std::move(made.value().mouse);
    lent_[i] = std::move(made.value().lent);
    (void)servo_->set_device(i, std::move(made.value().device));  // open_device saw its limits
  }
  return true;
}

void RemoteRun::let_go(std::size_t grip, const Error& why) {
  options_.tell("slosh: " + why.text());
  RemoteCommand command;
  command.grip = static_cast<std::uint32_t>(grip);
  command.take = false;
  visit_.ask(command);
}

void RemoteRun::pause(bool paused) {
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kWorld;
  command.action = paused ? wire::WorldAction::kPause : wire::WorldAction::kContinue;
  visit_.ask(command);
}

bool RemoteRun::start_again() {
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kWorld;
  command.action = wire::WorldAction::kReset;
  visit_.ask(command);
  return true;
}

void RemoteRun::change_grip() {
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kNextGrip;
  visit_.ask(command);
}

LiveValues RemoteRun::live_values() const {
  LiveValues values;
  values.may_change = status_.rights.parameters;
  values.gravity_scale = status_.world.gravity_scale;
  values.viscosities = status_.world.viscosities;
  values.grips = live_grips(stage_.scene, status_.world.grip_stiffness, *servo_);
  for (std::size_t i = 0; i < values.grips.size(); ++i)
    values.grips[i].may_set = may_set_stiffness(status_, i);
  return values;
}

void RemoteRun::change(const LiveWish& wish) {
  const std::optional<wire::Parameter> parameter = parameter_of(wish.kind);
  if (!parameter) return;
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kParameter;
  command.parameter = *parameter;
  command.index = static_cast<std::uint32_t>(wish.index);
  command.value = wish.value;
  visit_.ask(command);
}

std::string RemoteRun::hear(const std::string& line) {
  const PeerLine heard =
      peer_line(line, visit_.status(), stage_.scene, visit_.world().maker->delay(), steady_now_ns());
  for (const RemoteCommand& command : heard.commands) visit_.ask(command);
  if (heard.quit) request_stop();
  return heard.text;
}

void RemoteRun::report(RunSummary& s) const {
  const RemoteStatus status = visit_.status();
  const LinkNumbers& numbers = status.numbers;
  const SnapshotReport shown = visit_.world().maker->report();
  report_stage(stage_, s);
  report_time(elapsed_, to_seconds(stop_ns_ - start_ns_), s);
  report_hands(*loop_, *servo_, *recorder_, stage_.scene, s);
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
  n.age_ms = {1e3 * shown.age.percentile(0.5), 1e3 * shown.age.percentile(0.99), 1e3 * shown.age.max()};
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
