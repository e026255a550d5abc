#include "peer/app/local_run.h"

#include <array>

#include "net/clock.h"
#include "net/grip_start.h"
#include "peer/app/hand_trouble.h"
#include "peer/app/run_report.h"
#include "peer/app/settle_world.h"

namespace slosh {
namespace {

constexpr std::size_t kSnapshotBytes = std::size_t{512} << 20;

/// What kWorld, kParameter or kThing asks of a host.
HostCommand order_of(const RemoteCommand& command) {
  constexpr std::array kWorldActions{HostAction::kPause, HostAction::kContinue, HostAction::kReset};
  if (command.kind == RemoteCommand::Kind::kWorld)
    return {kWorldActions[static_cast<std::size_t>(command.action)]};
  if (command.kind == RemoteCommand::Kind::kThing)
    return {command.take ? HostAction::kAppear : HostAction::kTakeAway, command.index};
  HostAction action = HostAction::kGripStiffness;
  if (command.parameter == wire::Parameter::kFluidViscosity) action = HostAction::kViscosity;
  if (command.parameter == wire::Parameter::kGravityScale) action = HostAction::kGravityScale;
  return {action, command.index, command.value};
}

}  // namespace

Result<std::unique_ptr<LiveRun>> LocalRun::create(const Prepared& prepared, DeviceSet devices,
                                                  double snapshot_rate, Progress& progress) {
  std::unique_ptr<LocalRun> run(new LocalRun(prepared));
  const Scene& scene = prepared.scene;
  for (std::size_t i = 0; i < devices.devices.size(); ++i) {
    if (const Result<bool> opened = open_device(*devices.devices[i]); !opened) return opened.error();
    for (const std::string& note : hand_notes(scene, i, *devices.devices[i])) progress.note("slosh: " + note);
  }
  Result<World> made = make_world(scene, prepared.sampled, prepared.plan, prepared.world_options());
  if (!made) return made.error();
  World& world = made.value();
  // Where the scene asks for it the world comes to rest in the hands as they are. Nobody else reads the
  // devices yet.
  std::vector<HandleInput> hands;
  std::uint64_t felt = 0;
  for (const std::unique_ptr<Device>& device : devices.devices) {
    if (hands.size() < FluidDemand::kMaxGrips && device->gives_way())
      felt |= std::uint64_t{1} << hands.size();
    const DeviceReport report = device->read({0.0, 0.0});
    hands.push_back({report.pose, Twist{}, is_sound(report) && report.engaged, 1.0});
  }
  const Result<bool> settled = settle_world(world, prepared, hands, prepared.seconds, progress);
  if (!settled) return settled.error();
  if (snapshot_rate > 0.0) {
    // A GPU that also draws reads them where they are; the picture's side says where it does not.
    const Result<bool> shared = world.share_particles();
    if (!shared) progress.note("slosh: " + shared.error().text());
  }
  run->channel_ = std::make_unique<Channel>(scene.grips.size(), initial_message(world), kSnapshotBytes);
  HostOptions options;
  options.snapshot_rate = snapshot_rate;
  options.until = prepared.seconds;
  options.paced = !prepared.unpaced;
  run->fluid_demand_.want(felt);
  options.fluid_demand = &run->fluid_demand_;
  run->host_ = std::make_unique<Host>(std::move(world), scene, *run->channel_, options);
  Result<std::unique_ptr<WorldFiles>> files =
      WorldFiles::create(prepared, prepared.sampled, prepared.unpaced);
  if (!files) return files.error();
  run->files_ = std::move(files.value());
  const Result<bool> followed = run->files_->follow(*run->host_, prepared.record, prepared.backend);
  if (!followed) return followed.error();
  run->host_->add_tap(run->hands_tap_);
  run->host_->add_tap(run->window_tap_);
  if (!scene.task.empty()) {
    run->task_tap_ = std::make_unique<TaskTap>(
        scene, prepared.sampled, [host = run->host_.get()](const HostCommand& command, HostAnswer answer) {
          host->post(command, std::move(answer));
        });
    run->host_->add_tap(*run->task_tap_);
  }
  run->specs_ = devices.specs;
  run->another_device_ = devices.another;
  ServoOptions servo;
  servo.steps = &run->hands_tap_.steps();
  Result<std::unique_ptr<OwnHands>> own =
      OwnHands::create(prepared, std::move(devices), *run->channel_, servo, prepared.folder);
  if (!own) return own.error();
  run->hands_ = std::move(own.value());
  if (prepared.unpaced) {
    run->lockstep_ = std::make_unique<Lockstep>(run->hands_->servo(), *run->channel_);
    run->host_->add_tap(*run->lockstep_);
  }
  return std::unique_ptr<LiveRun>(std::move(run));
}

void LocalRun::start() {
  if (!lockstep_) hands_->start();  // first, so that the hands hold on when the first step is taken
  host_->start();
}

void LocalRun::request_stop() {
  if (lockstep_) lockstep_->request_stop();
  host_->request_stop();
}

void LocalRun::stop() {
  if (host_) {
    request_stop();
    host_->wait();
  }
  if (files_) files_->stop();
  if (hands_) hands_->stop();
  if (files_) files_->finish_recording();
}

LiveValues LocalRun::live_values() const {
  const HostState state = window_tap_.state();
  LiveValues values;
  values.may_change = true;
  values.gravity_scale = state.gravity_scale;
  values.viscosities = state.viscosities;
  values.grips = hands_->live_grips(state.grip_stiffness);
  values.may_pace = !prepared_.unpaced;
  values.pace = host_->pace();
  return values;
}

void LocalRun::change(const LiveWish& wish) {
  if (wish.kind == LiveWish::Kind::kPace) host_->set_pace(wish.value);
  LiveRun::change(wish);
}

PeerLine LocalRun::understand(const std::string& line) {
  const HostState state = window_tap_.state();
  return own_world_line(
      line, {state.paused, state.run, state.gravity_scale, state.viscosities, state.grip_stiffness},
      host_->progress().time, prepared_.scene);
}

/// The answer comes after the step that is under way, which may take long: nobody waits for it.
void LocalRun::ask(const RemoteCommand& command, bool typed) {
  const bool world = command.kind == RemoteCommand::Kind::kWorld;
  if (command.kind <= RemoteCommand::Kind::kNextGrip) return;  // every grip has its hand
  if (world && command.action != wire::WorldAction::kReset)
    paused_ = command.action == wire::WorldAction::kPause;
  const std::string said = typed ? done_text(command, prepared_.scene) : std::string();
  host_->post(order_of(command), [this, said](const Result<bool>& done) {
    if (!done) return window_tap_.tell(done.error().text());
    if (!said.empty()) window_tap_.tell(said);
  });
}

/// A script belongs to its grip, which has a motion of its own; what a person holds goes with their hand.
void LocalRun::follow_task(const std::vector<HandMove>& moves) {
  hands_moved_ = std::min(hands_moved_, moves.size());  // a task that began anew asks anew
  for (; hands_moved_ < moves.size(); ++hands_moved_) {
    const HandMove& move = moves[hands_moved_];
    if (move.from >= specs_.size() || move.to >= specs_.size()) continue;
    const std::string spec = specs_[move.from];
    if (spec.empty() || spec == "script") continue;
    specs_[move.from].clear();
    hands_->set(move.from, {});
    on_their_way_.push_back({move.from, move.to, spec, steady_now_ns()});
  }
  if (!on_their_way_.empty()) hand_over();
}

/// A device that is let go is closed once the device loop has parted with it: until then it may not open.
void LocalRun::hand_over() {
  constexpr double kLongest = 3.0;  // s
  const Handover next = on_their_way_.front();
  hands_->set(next.from, {});
  Result<HandDevice> made = another_device_(next.to, next.spec, grip_start(prepared_.scene, next.to));
  Result<bool> opened = true;
  if (made) opened = open_device(*made.value().device);
  if (made && opened) {
    hands_->set(next.to, std::move(made.value()));
    specs_[next.to] = next.spec;
  } else if (made && to_seconds(steady_now_ns() - next.since_ns) < kLongest) {
    return;
  } else {
    window_tap_.tell("the hand at " + prepared_.scene.grips[next.from].name + " cannot take " +
                     prepared_.scene.grips[next.to].name + ": " +
                     (made ? opened.error() : made.error()).text());
  }
  on_their_way_.erase(on_their_way_.begin());
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

Rates LocalRun::world_rates() {
  const HostProgress progress = host_->progress();
  hands_->follow_stiffness(window_tap_.state().grip_stiffness);
  Rates rates;
  rates.time = progress.time;
  rates.real_time = progress.rate;
  rates.step_rate = progress.step_rate;
  rates.step_ms = progress.step_ms;
  rates.status_steps = progress.status_steps;
  rates.lost = progress.lost;
  if (task_tap_) {
    rates.task = task_tap_->lines();
    follow_task(rates.task.hands);
    prepared_.ghost_clock->follow(rates.task.done, rates.time);
  }
  return rates;
}

void LocalRun::report(RunSummary& s) const {
  const HostReport& host = host_->report();
  report_stage(prepared_, s);
  report_time(host.simulated, host.wall, s);
  report_steps(host.total, host.step_time, s);
  hands_->report(s);
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
  if (!prepared_.folder.empty()) s.files = {"wrenches.csv", "poses.csv"};
  if (task_tap_) {
    report_task(prepared_.scene, task_tap_->done(), s);
    s.spilled_mass = task_tap_->spilled();
  }
  files_->report(host_->world(), s);
  for (std::string& sentence : hands_tap_.never_acted(prepared_.scene))
    s.problems.push_back(std::move(sentence));
}

}  // namespace slosh
