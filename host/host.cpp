#include "host/host.h"

#include <algorithm>
#include <chrono>

#include "host/pace_line.h"
#include "host/pacer.h"
#include "net/clock.h"

namespace slosh {
namespace {

constexpr double kStatusMemory = 0.5;  // simulated s that a status stays on show

}  // namespace

BodyMessage initial_message(const World& world, std::uint32_t run) {
  BodyMessage message;
  message.run = run;
  message.stamp_ns = steady_now_ns();
  message.time_step = world.plan().time_step;
  world.fill(message.bodies);
  return message;
}

Host::Host(World world, const Scene& scene, Channel& channel, HostOptions options)
    : world_(std::move(world)),
      channel_(channel),
      options_(std::move(options)),
      gate_(scene),
      schedule_(world_.plan().time_step),
      fluid_models_(scene) {
  for (const Grip& grip : scene.grips) grip_bodies_.push_back(grip.body);
  for (const Body& body : scene.bodies) body_names_.push_back(body.name);
  modelled_.resize(scene.bodies.size());
  fluids_ = scene.fluids.size();
  start_state_ = std::move(options_.start_state);
  if (start_state_.empty()) (void)world_.save(start_state_);  // a world that cannot be saved refuses a reset
  paused_ = options_.paused;
  run_ = options_.run;
  show_state();
  world_.fill(latest_);
  gone_.update(latest_);  // of a world that was restored: told then
  report_.start = world_.diagnostics();
  show_lost();
}

Host::~Host() {
  request_stop();
  wait();
}

void Host::start() {
  if (thread_.joinable()) return;
  running_.store(true, std::memory_order_release);
  thread_ = std::thread([this] { run(); });
}

void Host::wait() {
  if (thread_.joinable()) thread_.join();
}

HostProgress Host::progress() const {
  HostProgress progress;
  progress.time = shown_time_.load(std::memory_order_relaxed);
  progress.rate = shown_rate_.load(std::memory_order_relaxed);
  progress.step_rate = shown_step_rate_.load(std::memory_order_relaxed);
  progress.step_ms = shown_step_ms_.load(std::memory_order_relaxed);
  progress.run = shown_run_.load(std::memory_order_relaxed);
  progress.paused = shown_paused_.load(std::memory_order_relaxed);
  progress.tick = shown_tick_.load(std::memory_order_relaxed);
  progress.status = shown_status_.load(std::memory_order_relaxed);
  for (std::size_t bit = 0; bit < progress.status_steps.size(); ++bit)
    progress.status_steps[bit] = shown_status_steps_[bit].load(std::memory_order_relaxed);
  progress.lost = shown_lost_.load(std::memory_order_relaxed);
  return progress;
}

std::int64_t Host::clock_ns() const {
  return options_.paced ? steady_now_ns() : simulated_ns_;
}

void Host::note_status(std::uint32_t status) {
  report_.status |= status;
  for (int bit = 0; bit < 32; ++bit) {
    if (!(status & (1u << bit))) continue;
    status_until_[bit] = world_.time() + kStatusMemory;
    const auto at = static_cast<std::size_t>(bit);
    report_.status_steps[at] += 1;
    shown_status_steps_[at].store(report_.status_steps[at], std::memory_order_relaxed);
  }
}

std::uint32_t Host::recent_status() const {
  std::uint32_t status = 0;
  for (int bit = 0; bit < 32; ++bit) {
    if (status_until_[bit] > world_.time()) status |= 1u << bit;
  }
  return status;
}

// Of bodies that a hand holds for whom somebody asks.
void Host::model_fluid(std::span<const HandleInput> input) {
  const std::uint64_t wanted = options_.fluid_demand ? options_.fluid_demand->wanted() : 0;
  models_.clear();
  if (wanted == 0) return fluid_models_.restart();
  std::fill(modelled_.begin(), modelled_.end(), char{0});
  for (std::size_t g = 0; g < input.size() && g < FluidDemand::kMaxGrips; ++g) {
    if ((wanted >> g & 1) != 0 && input[g].engaged) modelled_[static_cast<std::size_t>(grip_bodies_[g])] = 1;
  }
  fluid_models_.after_step(world_, latest_, modelled_, models_);
  report_.fluid_models += models_.size();
}

void Host::publish_bodies(double rate, std::int64_t stamp_ns) {
  BodyMessage& message = channel_.bodies().back();
  world_.fill(message.bodies);
  message.bodies.status = recent_status();
  message.run = run_;
  const std::span<const PoseMessage> used = gate_.poses();
  message.pose_numbers.resize(used.size());
  message.fluid_models = models_;
  message.hands.resize(used.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    const PoseMessage& pose = used[i];
    message.pose_numbers[i] = pose.number;
    message.hands[i] = {pose.number, pose.stamp_ns, pose.time, pose.counted, pose.energy, pose.stand};
  }
  message.rate = rate;
  message.time_step = world_.plan().time_step;
  message.stamp_ns = stamp_ns;
  channel_.bodies().publish();
}

void Host::publish_snapshot() {
  if (options_.snapshot_rate <= 0.0) return;
  if (options_.demand) options_.demand->note_made(run_);
  auto snapshot = std::make_shared<Snapshot>();
  if (options_.shell) {
    world_.fill(*snapshot, true);
  } else {
    world_.fill_later(*snapshot);
  }
  snapshot->rigid.status = recent_status();
  if (channel_.snapshots().push(std::move(snapshot))) report_.snapshots += 1;
}

void Host::publish_snapshot_if_due() {
  const double half_step = 0.5 * world_.plan().time_step;
  if (options_.snapshot_rate <= 0.0 || world_.time() + half_step < next_snapshot_) return;
  if (!options_.demand || options_.demand->wanted()) publish_snapshot();
  next_snapshot_ += 1.0 / options_.snapshot_rate;
}

void Host::tell_published() {
  for (HostTap* tap : taps_) tap->after_publish();
}

void Host::tell_refused() {
  const std::span<const PoseFault> refused = gate_.refused();
  for (std::uint32_t grip = 0; grip < refused.size(); ++grip) {
    if (refused[grip] == PoseFault::kNone) continue;
    for (HostTap* tap : taps_) tap->on_refused_pose(grip, refused[grip]);
  }
}

void Host::tell_gone() {
  for (const GoneBody& gone : gone_.update(latest_)) {
    const auto body = static_cast<std::size_t>(gone.body);
    const std::string words = gone_text(body_names_[body], gone);
    if (report_.gone.size() < kMaxGone) report_.gone.push_back(words);
    for (HostTap* tap : taps_) tap->on_gone_body(body, words);
  }
}

// Sums over the fluid: asked for only when a particle can have been lost.
void Host::show_lost() {
  shown_lost_.store(world_.diagnostics().lost, std::memory_order_relaxed);
}

void Host::show_state() {
  shown_time_.store(world_.time(), std::memory_order_relaxed);
  shown_tick_.store(world_.tick(), std::memory_order_relaxed);
  shown_run_.store(run_, std::memory_order_relaxed);
  shown_paused_.store(paused_, std::memory_order_relaxed);
}

void Host::Schedule::restart() {
  begin_ns = steady_now_ns();
  pacer.restart(begin_ns);
  line.restart(begin_ns);
  meter.restart(begin_ns);
}

void Host::run() {
  begin_run();
  while (!stop_.load(std::memory_order_relaxed) &&
         world_.time() + 0.5 * world_.plan().time_step < options_.until) {
    if (options_.pulse != nullptr) options_.pulse->fetch_add(1, std::memory_order_relaxed);
    if (has_orders_.load(std::memory_order_acquire)) run_commands();
    // One step of a world that stands, or it stands on.
    const bool single = paused_ && take_asked_step();
    if (paused_ && !single) {
      stand();
      continue;
    }
    const Turn turn = wait_for_turn(single);
    const double seconds = step(take_inputs());
    publish(turn, single);
    count(seconds);
  }
  end_run();
}

void Host::begin_run() {
  schedule_.restart();
  simulated_ns_ = schedule_.begin_ns;
  next_snapshot_ = world_.time();
  for (HostTap* tap : taps_) tap->on_start(world_, state());
  // The first snapshot of a run comes whether somebody looks or not: those who count runs need it.
  publish_snapshot();
  next_snapshot_ += options_.snapshot_rate > 0.0 ? 1.0 / options_.snapshot_rate : 0.0;
  // The clock of a run that is not paced begins with the first state that its hands see: how long there was
  // from making it to here is the machine's.
  if (!options_.paced) publish_bodies(0.0, clock_ns());
  tell_published();
}

void Host::stand() {
  report_.wall += to_seconds(steady_now_ns() - schedule_.begin_ns);
  stand_still();
  schedule_.restart();
}

Host::Turn Host::wait_for_turn(bool single) {
  if (!single) steps_asked_.store(0, std::memory_order_relaxed);
  Turn turn{{}, options_.paced ? pace_.load(std::memory_order_relaxed) : 1.0};
  if (!options_.paced || single) return turn;
  schedule_.pacer.set_period(world_.plan().time_step / turn.pace, steady_now_ns());
  turn.at = schedule_.pacer.next(steady_now_ns());
  if (turn.at.slipped) note_status(kStatusTimeSlipped);
  sleep_until_ns(turn.at.deadline_ns);
  return turn;
}

std::span<const HandleInput> Host::take_inputs() {
  const std::uint64_t rejected_before = gate_.rejected();
  const std::span<const HandleInput> input = gate_.take(channel_, latest_, clock_ns());
  if (gate_.rejected() != rejected_before) {
    note_status(kStatusInputRejected);
    tell_refused();
  }
  return input;
}

double Host::step(std::span<const HandleInput> input) {
  for (HostTap* tap : taps_) tap->before_step(world_, {input, gate_.poses()});
  const std::int64_t begin_ns = steady_now_ns();
  world_.step(input);
  schedule_.stepped_ns = steady_now_ns();
  simulated_ns_ += to_nanoseconds(world_.plan().time_step);

  const std::uint32_t status = world_.take_status();
  note_status(status);
  if ((status & kStatusNonFinite) != 0) show_lost();
  world_.fill(latest_);
  tell_gone();
  model_fluid(input);
  for (HostTap* tap : taps_) tap->after_step(world_);
  return to_seconds(schedule_.stepped_ns - begin_ns);
}

void Host::publish(const Turn& turn, bool single) {
  if (single) {
    publish_bodies(0.0, clock_ns());
    publish_snapshot();
    next_snapshot_ = std::max(next_snapshot_, world_.time());
  } else {
    const PaceLine::Moment moment =
        options_.paced
            ? schedule_.line.after_step(world_.plan().time_step, turn.pace, turn.at, schedule_.stepped_ns)
            : PaceLine::Moment{simulated_ns_, turn.pace};
    publish_bodies(moment.rate, moment.stamp_ns);
    publish_snapshot_if_due();
  }
  tell_published();
}

void Host::count(double seconds) {
  report_.steps += 1;
  report_.step_time.add(seconds);
  report_.total += world_.times();
  show_state();
  shown_status_.store(recent_status(), std::memory_order_relaxed);
  if (schedule_.meter.add(seconds, schedule_.stepped_ns)) {
    shown_rate_.store(schedule_.meter.step_rate * world_.plan().time_step, std::memory_order_relaxed);
    shown_step_rate_.store(schedule_.meter.step_rate, std::memory_order_relaxed);
    shown_step_ms_.store(schedule_.meter.step_ms, std::memory_order_relaxed);
  }
}

void Host::end_run() {
  if (options_.pulse != nullptr) options_.pulse->store(0, std::memory_order_relaxed);
  report_.wall += to_seconds(steady_now_ns() - schedule_.begin_ns);
  report_.simulated = static_cast<double>(report_.steps) * world_.plan().time_step;
  report_.slips = schedule_.pacer.slips();
  report_.slipped = schedule_.pacer.slipped_seconds();
  report_.rejected_poses = gate_.rejected();
  report_.diagnostics = world_.diagnostics();
  publish_bodies(0.0, clock_ns());
  channel_.snapshots().close();
  for (HostTap* tap : taps_) tap->on_end(world_);
  tell_published();
  end_commands();
  running_.store(false, std::memory_order_release);
}

}  // namespace slosh
