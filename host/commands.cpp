// The part of the host that does what it is asked between steps.
#include <chrono>
#include <utility>

#include "host/host.h"
#include "host/keep/rebuild.h"
#include "net/clock.h"

namespace slosh {
namespace {

const Error kOver{"the world", "has ended", ""};

}  // namespace

void Host::post(const HostCommand& command, HostAnswer answer) {
  {
    const std::lock_guard lock(orders_mutex_);
    if (!over_) {
      orders_.push_back({command, std::move(answer)});
      has_orders_.store(true, std::memory_order_release);
      ordered_.notify_one();
      return;
    }
  }
  if (answer) answer(kOver);
}

std::future<Result<bool>> Host::ask(const HostCommand& command) {
  auto promise = std::make_shared<std::promise<Result<bool>>>();
  post(command, [promise](const Result<bool>& answer) { promise->set_value(answer); });
  return promise->get_future();
}

void Host::run_commands() {
  std::vector<Order> orders;
  {
    const std::lock_guard lock(orders_mutex_);
    orders.swap(orders_);
    has_orders_.store(false, std::memory_order_relaxed);
  }
  for (Order& order : orders) {
    const Result<bool> done = carry_out(order.command);
    if (done) {
      show_state();
      for (HostTap* tap : taps_) tap->after_change(world_, order.command, state());
    }
    if (order.answer) order.answer(done);
  }
}

void Host::end_commands() {
  std::vector<Order> orders;
  {
    const std::lock_guard lock(orders_mutex_);
    over_ = true;
    orders.swap(orders_);
  }
  for (Order& order : orders) {
    if (order.answer) order.answer(kOver);
  }
}

Result<bool> Host::carry_out(const HostCommand& command) {
  switch (command.action) {
    case HostAction::kPause:
      paused_ = true;
      publish_bodies(0.0, clock_ns());
      return true;
    case HostAction::kContinue:
      paused_ = false;
      return true;
    case HostAction::kReset:
      return reset();
    default:
      return change_world(world_, command);
  }
}

Result<bool> change_world(World& world, const HostCommand& command) {
  switch (command.action) {
    case HostAction::kViscosity:
      return world.set_viscosity(command.index, command.value);
    case HostAction::kGravityScale:
      return world.set_gravity_scale(command.value);
    case HostAction::kGripStiffness:
      return world.set_grip_stiffness(command.index, command.value);
    case HostAction::kAppear:
      return world.appear(command.index);
    case HostAction::kTakeAway:
      return world.take_away(command.index, static_cast<int>(command.value) - 1);
    case HostAction::kPause:
    case HostAction::kContinue:
    case HostAction::kReset:
      break;
  }
  return true;
}

Result<bool> Host::reset() {
  const Result<bool> restored = keep::reset_world(world_, fluids_, start_state_);
  if (!restored) return restored;
  run_ += 1;
  for (double& until : status_until_) until = 0.0;
  show_lost();
  world_.fill(latest_);
  gone_.update(latest_);
  gate_.reset(latest_, clock_ns());
  models_.clear();
  fluid_models_.restart();
  publish_bodies(0.0, clock_ns());
  publish_snapshot();
  next_snapshot_ = world_.time() + (options_.snapshot_rate > 0.0 ? 1.0 / options_.snapshot_rate : 0.0);
  return true;
}

HostState state_of(const World& world, std::size_t fluids, bool paused, std::uint32_t run) {
  HostState state{paused, run, world.gravity_scale(), {}, {}};
  state.grip_stiffness.assign(world.grip_stiffness().begin(), world.grip_stiffness().end());
  for (std::size_t i = 0; i < fluids; ++i) state.viscosities.push_back(world.viscosity(i));
  return state;
}

HostState Host::state() const {
  return state_of(world_, fluids_, paused_, run_);
}

bool Host::take_asked_step() {
  int asked = steps_asked_.load(std::memory_order_relaxed);
  while (asked > 0 && !steps_asked_.compare_exchange_weak(asked, asked - 1)) {
  }
  return asked > 0;
}

void Host::stand_still() {
  publish_bodies(0.0, clock_ns());
  tell_published();
  shown_rate_ = 0.0;
  while (paused_ && !stop_.load(std::memory_order_relaxed) &&
         steps_asked_.load(std::memory_order_relaxed) == 0) {
    {
      // A stop may come from a signal and wakes nobody.
      std::unique_lock lock(orders_mutex_);
      ordered_.wait_for(lock, std::chrono::milliseconds(5), [this] { return !orders_.empty(); });
    }
    // Somebody began to look while the world stands: show it as it is.
    if (options_.demand && options_.demand->take_ask()) {
      publish_snapshot();
      tell_published();
    }
    for (HostTap* tap : taps_) tap->while_standing(world_);
    if (!has_orders_.load(std::memory_order_acquire)) continue;
    run_commands();
    tell_published();
  }
  gate_.stood_still();
}

}  // namespace slosh
