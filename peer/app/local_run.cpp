#include "peer/app/local_run.h"

#include <algorithm>
#include <array>

#include "peer/app/all_left.h"
#include "peer/app/hand_trouble.h"
#include "peer/app/interrupt.h"
#include "peer/app/live_grips.h"
#include "peer/app/run_report.h"
#include "peer/app/time_estimate.h"
#include "peer/remote/peer_console.h"

namespace slosh {
namespace {

constexpr std::size_t kSnapshotBytes = std::size_t{512} << 20;

HostAction action_of(wire::Parameter parameter) {
  switch (parameter) {
    case wire::Parameter::kFluidViscosity:
      return HostAction::kViscosity;
    case wire::Parameter::kGravityScale:
      return HostAction::kGravityScale;
    case wire::Parameter::kGripStiffness:
      break;
  }
  return HostAction::kGripStiffness;
}

}  // namespace

Result<std::unique_ptr<LocalRun>> LocalRun::create(const Prepared& prepared, DeviceSet devices,
                                                   double snapshot_rate, Progress* progress) {
  std::unique_ptr<LocalRun> run(new LocalRun(prepared));
  const Scene& scene = prepared.scene;
  for (std::size_t i = 0; i < devices.devices.size(); ++i) {
    const Result<bool> opened = open_device(*devices.devices[i]);
    if (!opened) return opened.error();
    if (progress == nullptr) continue;
    for (const std::string& note : hand_notes(scene, i, *devices.devices[i]))
      progress->note("slosh: " + note);
  }
  Result<World> made =
      make_world(scene, prepared.sampled, prepared.plan, WorldOptions{prepared.threads, prepared.backend});
  if (!made) return made.error();
  World world = std::move(made.value());
  // Where the scene asks for it the world comes to rest in the hands as they are. Nobody else reads the
  // devices yet.
  std::vector<HandleInput> hands;
  for (const std::unique_ptr<Device>& device : devices.devices) {
    const DeviceReport report = device->read({0.0, 0.0});
    hands.push_back({report.pose, Twist{}, is_sound(report) && report.engaged, 1.0});
  }
  if (progress != nullptr) {
    const Result<bool> agreed = agree_on_time(
        world, hands, {scene.settle, prepared.seconds, !prepared.unpaced, prepared.agreed}, *progress);
    if (!agreed) return agreed.error();
  }
  // Where a run begins again the first signal is not to wait for this.
  const auto stopped = [] { return interrupted_by() != 0; };
  world.settle(scene.settle, hands, stopped, scene.settle_longest);
  if (const std::optional<Error> nothing = all_left(world, scene)) return *nothing;
  if (snapshot_rate > 0.0) {
    // A GPU that also draws reads them where they are; the picture's side says where it does not.
    const Result<bool> shared = world.share_particles();
    if (!shared && progress) progress->note("slosh: " + shared.error().text());
  }
  run->channel_ = std::make_unique<Channel>(scene.grips.size(), initial_message(world), kSnapshotBytes);
  HostOptions options;
  options.snapshot_rate = snapshot_rate;
  options.until = prepared.seconds;
  options.paced = !prepared.unpaced;
  std::uint64_t felt = 0;
  for (std::size_t i = 0; i < devices.devices.size() && i < FluidDemand::kMaxGrips; ++i) {
    if (devices.devices[i] && devices.devices[i]->gives_way()) felt |= std::uint64_t{1} << i;
  }
  run->fluid_demand_.want(felt);
  options.fluid_demand = &run->fluid_demand_;
  run->host_ = std::make_unique<Host>(std::move(world), scene, *run->channel_, options);
  if (!prepared.record.empty()) {
    keep::RecordingOptions recording;
    recording.file = prepared.record;
    recording.version = SLOSH_VERSION;
    recording.backend = backend_name(prepared.backend);
    const Host& host = *run->host_;
    Result<std::unique_ptr<keep::RecordingWriter>> writer = keep::RecordingWriter::start(
        scene, prepared.sampled.spacing, host.start_state(), host.world(), host.state(), recording);
    if (!writer) return writer.error();
    run->recording_ = std::move(writer.value());
    run->host_->add_tap(*run->recording_);
  }
  run->wrenches_ = std::make_unique<WrenchTap>(scene.grips.size());
  run->host_->add_tap(*run->wrenches_);
  run->host_->add_tap(run->switches_);
  run->hands_ = std::make_unique<HandsTap>(scene.grips.size());
  run->host_->add_tap(*run->hands_);
  run->mouse_targets_ = std::move(devices.mouse_targets);
  run->lent_ = std::move(devices.lent);
  ServoOptions servo;
  servo.steps = &run->wrenches_->steps();
  servo.sample_interval = 1.0 / prepared.row_rate;
  servo.signals = prepared.signals;
  run->servo_ = std::make_unique<Servo>(scene, std::move(devices.devices), *run->channel_, servo);
  run->loop_ = std::make_unique<DeviceLoop>(*run->servo_);
  if (prepared.measure > 0.0) {
    Result<std::unique_ptr<Measurer>> measurer =
        Measurer::create(scene, prepared.sampled, prepared.folder, prepared.measure);
    if (!measurer) return measurer.error();
    run->measurer_ = std::move(measurer.value());
    run->measure_tap_ = std::make_unique<MeasureTap>(*run->measurer_);
    run->host_->add_tap(*run->measure_tap_);
  }
  if (!prepared.exports.empty()) {
    Result<std::unique_ptr<Exporter>> exporter =
        start_export(prepared, prepared.sampled.spacing, prepared.unpaced);
    if (!exporter) return exporter.error();
    run->exporter_ = std::move(exporter.value());
    run->export_tap_ = std::make_unique<ExportTap>(*run->exporter_);
    run->host_->add_tap(*run->export_tap_);
  }
  run->host_->add_tap(run->pressure_tap_);
  if (prepared.unpaced) {
    run->lockstep_ = std::make_unique<Lockstep>(*run->servo_, *run->channel_);
    run->host_->add_tap(*run->lockstep_);
  }
  Result<std::unique_ptr<Recorder>> recorder = Recorder::start(*run->servo_, prepared.folder);
  if (!recorder) return recorder.error();
  run->recorder_ = std::move(recorder.value());
  return run;
}

LocalRun::~LocalRun() {
  stop();
}

void LocalRun::start() {
  if (!lockstep_) loop_->start();  // first, so that the hands hold on when the first step is taken
  host_->start();
}

void LocalRun::stop() {
  if (host_) {
    request_stop();
    host_->wait();
  }
  if (measurer_) measurer_->stop();
  if (exporter_) exporter_->stop();
  if (loop_) loop_->stop();
  if (servo_) servo_->close_devices();
  if (recorder_) recorder_->stop();
  if (recording_) recorded_ = recording_->finish();
}

std::string LocalRun::trouble() const {
  std::string problem = recorder_->problem();
  if (problem.empty() && measurer_) problem = measurer_->problem();
  if (problem.empty() && exporter_) problem = exporter_->problem();
  return run_trouble(problem, *servo_, prepared_.scene);
}

bool LocalRun::start_again() {
  host_->post({HostAction::kReset});
  return true;
}

LiveValues LocalRun::live_values() const {
  const HostState state = switches_.state();
  LiveValues values;
  values.may_change = true;
  values.gravity_scale = state.gravity_scale;
  values.viscosities = state.viscosities;
  values.grips = live_grips(prepared_.scene, state.grip_stiffness, *servo_);
  values.may_pace = !prepared_.unpaced;
  values.pace = host_->pace();
  return values;
}

void LocalRun::change(const LiveWish& wish) {
  if (wish.kind == LiveWish::Kind::kPace) {
    host_->set_pace(wish.value);
    return;
  }
  const std::optional<wire::Parameter> parameter = parameter_of(wish.kind);
  if (!parameter) return;
  const HostCommand command{action_of(*parameter), static_cast<std::uint32_t>(wish.index), wish.value};
  host_->post(command, [this](const Result<bool>& done) {
    if (!done) switches_.tell(done.error().text());
  });
}

std::string LocalRun::hear(const std::string& line) {
  const HostState state = switches_.state();
  const PeerLine heard = own_world_line(
      line, {state.paused, state.run, state.gravity_scale, state.viscosities, state.grip_stiffness},
      host_->progress().time, prepared_.scene);
  for (const RemoteCommand& command : heard.commands) carry_out(command);
  if (heard.quit) request_stop();
  return heard.text;
}

/// The answer comes after the step that is under way, which may take long: nobody waits for it.
void LocalRun::carry_out(const RemoteCommand& command) {
  constexpr std::array kWorldActions{HostAction::kPause, HostAction::kContinue, HostAction::kReset};
  HostCommand order;
  if (command.kind == RemoteCommand::Kind::kWorld) {
    order.action = kWorldActions[static_cast<std::size_t>(command.action)];
    if (command.action != wire::WorldAction::kReset) paused_ = command.action == wire::WorldAction::kPause;
  } else {
    order = {action_of(command.parameter), command.index, command.value};
  }
  host_->post(order, [this, said = done_text(command, prepared_.scene)](const Result<bool>& done) {
    switches_.tell(done ? said : done.error().text());
  });
}

HudFacts LocalRun::facts(double picture_rate) const {
  HudFacts facts;
  facts.title = prepared_.scene.name;
  facts.spacing = prepared_.sampled.spacing;
  facts.fluid_particles = prepared_.sampled.fluid_positions.size();
  for (const SurfaceSamples& surface : prepared_.sampled.surfaces) {
    facts.boundary_particles += surface.positions.size();
  }
  facts.picture_rate = picture_rate;
  facts.counts_fluid = true;
  facts.walls_hold = prepared_.plan.walls_hold();
  return facts;
}

Rates LocalRun::note_rates() {
  const HostProgress progress = host_->progress();
  follow_stiffness(switches_.state().grip_stiffness, *servo_);
  Rates rates;
  rates.time = progress.time;
  rates.real_time = progress.rate;
  rates.step_rate = progress.step_rate;
  rates.step_ms = progress.step_ms;
  rates.status_steps = progress.status_steps;
  rates.lost = progress.lost;
  rates.device_rate = servo_->devices() == 0 ? 0.0 : loop_->rate();
  rates.device_status = servo_->status();
  rates.budgets = budget_lines(*servo_, prepared_.scene);
  rates_.add(rates);
  return rates;
}

void LocalRun::report(RunSummary& s) const {
  const HostReport& host = host_->report();
  report_stage(prepared_, s);
  report_time(host.simulated, host.wall, s);
  report_steps(host.total, host.step_time, s);
  report_hands(*loop_, *servo_, *recorder_, prepared_.scene, s);
  s.spacing = prepared_.sampled.spacing;
  s.spacing_reason = prepared_.spacing_reason;
  s.fluid_particles = host_->world().fluid_count();
  s.boundary_particles = host_->world().boundary_count();
  report_left(host.diagnostics, host.start, prepared_.plan, s);
  s.steps = host.steps;
  s.time_step = prepared_.plan.time_step;
  s.status |= host.status;
  s.status_steps = host.status_steps;
  s.gone = host.gone;
  s.slips = host.slips;
  s.slipped = host.slipped;
  s.rejected_poses += host.rejected_poses;
  s.backend = backend_name(prepared_.backend);
  s.threads = prepared_.threads;
  if (recording_) {
    s.recording = prepared_.record.string();
    s.recording_problem = !recorded_.problem.empty() ? recorded_.problem : recorded_.totals.ended_early;
  }
  if (!prepared_.folder.empty()) s.files = {"wrenches.csv", "poses.csv"};
  report_instruments(measurer_.get(), prepared_.scene, prepared_.sampled, host_->world(), s);
  report_export(exporter_.get(), s);
  for (std::string& sentence : hands_->never_acted(prepared_.scene))
    s.problems.push_back(std::move(sentence));
}

}  // namespace slosh
