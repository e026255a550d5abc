#include "peer/python/remote_program.h"

#include <algorithm>
#include <ctime>

#include "net/clock.h"
#include "net/grip_start.h"
#include "net/link.h"
#include "peer/haptics/script_device.h"
#include "peer/python/hand.h"
#include "peer/python/words.h"
#include "peer/python/world_program.h"
#include "peer/remote/peer_key.h"

namespace slosh::python {
namespace {

constexpr std::int64_t kPeriodNs = 1'000'000;  // of the device loop

Identity identity_for(const std::filesystem::path& key) {
  if (key.empty()) return Identity::generate();
  return python::take(open_peer_key(key)).identity;
}

}  // namespace

RemoteProgram::RemoteProgram(const std::string& link_text, const RemoteProgramOptions& options) {
  if (!(options.timeout > 0.0 && options.timeout <= 3600.0))
    throw py::value_error("timeout: above 0 s, an hour at most");
  const JoinLink link = python::take(parse_link(link_text));
  RemoteOptions remote;
  remote.token = link.token;
  remote.name = options.name;
  for (const std::string& address : link.addresses)
    remote.address += (remote.address.empty() ? "" : ", ") + address;
  remote.wants_grip = !options.watch;
  remote.grips = options.grips;
  remote.answer_within = options.timeout;
  remote.snapshots.wanted = options.particles;
  visit_ = std::make_unique<RemoteVisit>(remote, connect_by(link, identity_for(options.key)));
  const std::int64_t until_ns = steady_now_ns() + to_nanoseconds(options.timeout);
  Interrupts interrupts;
  without_lock(interrupts, [&] {
    for (;;) {
      const LinkState state = visit_->wait_until_live(std::chrono::milliseconds(20));
      if (state == LinkState::kLive) return;
      const RemoteStatus now = visit_->status();
      if (state == LinkState::kEnded)
        throw Raised(
            now.error ? *now.error
                      : Error{remote.address, "the host ended before the world came: " + now.farewell, ""});
      if (steady_now_ns() > until_ns)
        throw Raised({remote.address, "no world came within " + std::to_string(options.timeout) + " s",
                      "Is the host still running? A longer timeout helps on a slow line"});
      interrupts.check();
    }
  });
  scene_ = std::make_shared<Scene>(visit_->world().scene);
  spacing_ = visit_->world().spacing;
  lent_.resize(scene_->grips.size());
  keys_.resize(scene_->grips.size());
  for (std::size_t i = 0; i < keys_.size(); ++i) keys_[i] = scene_->grips[i].hand_motion;
  has_device_.assign(scene_->grips.size(), false);
  servo_ = std::make_unique<Servo>(*scene_, std::vector<std::unique_ptr<Device>>{}, *visit_->world().channel,
                                   ServoOptions{});
  newest_.note(visit_->world().channel->bodies().front());
  {
    const std::lock_guard lock(mutex_);
    follow_grips(visit_->status());
  }
  loop_ = std::thread([this] { run(); });
  if (!options.watch) wait_for_a_grip();
}

/// The host's answer comes a round trip after the world; where no grip is free, none is held.
void RemoteProgram::wait_for_a_grip() {
  const std::int64_t until_ns = steady_now_ns() + to_nanoseconds(2.0);
  Interrupts interrupts;
  without_lock(interrupts, [&] {
    while (steady_now_ns() < until_ns) {
      {
        const std::lock_guard lock(mutex_);
        if (std::find(has_device_.begin(), has_device_.end(), true) != has_device_.end()) return;
      }
      interrupts.check();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
}

RemoteProgram::~RemoteProgram() {
  const py::gil_scoped_release released;
  stop_ = true;
  if (visit_) visit_->stop();
  if (loop_.joinable()) loop_.join();
}

/// The device loop: hands to the host, the host's states to whoever asks. This thread alone reads the
/// channel.
void RemoteProgram::run() {
  Channel& channel = *visit_->world().channel;
  std::int64_t due_ns = steady_now_ns();
  std::int64_t look_ns = 0;
  while (!stop_.load(std::memory_order_relaxed)) {
    {
      const std::lock_guard lock(mutex_);
      const std::int64_t now_ns = steady_now_ns();
      servo_->tick(now_ns);
      newest_.note(channel.bodies().front());
      if (now_ns >= look_ns) {
        look_ns = now_ns + 20 * kPeriodNs;
        follow_grips(visit_->status());
      }
    }
    due_ns = std::max(due_ns + kPeriodNs, steady_now_ns() - 10 * kPeriodNs);
    const timespec until{due_ns / 1'000'000'000, due_ns % 1'000'000'000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  }
  servo_->let_go();
  servo_->close_devices();
}

std::unique_ptr<Device> RemoteProgram::make_hand(std::size_t grip) {
  const Pose start = grip_start(*scene_, grip);
  if (!lent_[grip]) lent_[grip] = std::make_shared<SharedHandle>(start);
  auto script = std::make_unique<TrackDevice>(PoseTrack(keys_[grip], start), "program");
  return std::make_unique<SharedHandleDevice>(std::move(script), lent_[grip]);
}

/// A device on each grip that is ours, none on the others.
void RemoteProgram::follow_grips(const RemoteStatus& status) {
  for (std::size_t i = 0; i < has_device_.size(); ++i) {
    const bool held = i < status.held.size() && status.held[i];
    if (held == has_device_[i]) continue;
    has_device_[i] = held;
    (void)servo_->set_device(i, held ? make_hand(i) : nullptr);
  }
}

RemoteVisit& RemoteProgram::visit() {
  if (stop_) throw Raised({"slosh.Remote", "the visit is over", "Join again"});
  return *visit_;
}

RemoteStatus RemoteProgram::status() {
  RemoteStatus now = visit_->status();
  if (now.state == LinkState::kEnded && now.error && !stop_) throw Raised(*now.error);
  return now;
}

BodyMessage RemoteProgram::newest() {
  const std::lock_guard lock(mutex_);
  return newest_.state();
}

SnapshotPointer RemoteProgram::picture() {
  if (SnapshotPointer newest = visit().world().maker->newest(steady_now_ns())) picture_ = newest;
  return picture_;
}

std::size_t RemoteProgram::grip(const py::object& which) const {
  std::vector<std::string> names;
  for (const Grip& g : scene_->grips) names.push_back(g.name);
  return index_of(which, names, "grip");
}

void RemoteProgram::hold(const py::object& which, const py::object& source) {
  const std::size_t i = grip(which);
  (void)visit();
  const bool by_keys = py::isinstance<Keys>(source);
  const std::lock_guard lock(mutex_);
  if (!has_device_[i])
    throw Raised(
        {"grip '" + scene_->grips[i].name + "'", "is not ours", "take() it first, or join with grips=[...]"});
  if (by_keys || source.is_none()) {
    if (by_keys) keys_[i] = source.cast<const Keys&>().keys;
    lent_[i].reset();
    (void)servo_->set_device(i, make_hand(i));
    return;
  }
  SharedHandle::Wish& wish = lent_[i]->wish.back();
  wish.taken = true;
  wish.pose = to_hand_pose(source, grip_start(*scene_, i)).pose;
  lent_[i]->wish.publish();
}

Pose RemoteProgram::handle(std::size_t i) {
  const std::lock_guard lock(mutex_);
  if (!has_device_[i] || !lent_[i]) return newest_.state().bodies.grips.at(i).handle;
  lent_[i]->now.update();
  return lent_[i]->now.front();
}

void RemoteProgram::take(const py::object& which, bool take) {
  RemoteCommand command;
  command.grip = static_cast<std::uint32_t>(grip(which));
  command.take = take;
  visit().ask(command);
  const std::int64_t until_ns = steady_now_ns() + to_nanoseconds(5.0);
  Interrupts interrupts;
  const std::size_t i = command.grip;
  without_lock(interrupts, [&] {
    for (;;) {
      {
        const std::lock_guard lock(mutex_);
        if (has_device_[i] == take) return;
      }
      if (steady_now_ns() > until_ns || visit_->status().state == LinkState::kEnded)
        throw Raised({"grip '" + scene_->grips[i].name + "'",
                      take ? "was not given to us" : "was not let go of", "notices() has the host's words"});
      interrupts.check();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
}

std::vector<ServoSample> RemoteProgram::samples() {
  std::vector<ServoSample> out;
  ServoSample sample;
  while (servo_->samples().pop(sample)) out.push_back(sample);
  return out;
}

void RemoteProgram::wait(double seconds) {
  if (!(seconds >= 0.0 && seconds <= 86400.0)) throw py::value_error("seconds: 0 to a day");
  const std::int64_t until_ns = steady_now_ns() + to_nanoseconds(seconds);
  Interrupts interrupts;
  without_lock(interrupts, [&] {
    while (steady_now_ns() < until_ns && visit_->status().state != LinkState::kEnded) {
      interrupts.check();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  });
  const RemoteStatus now = status();
  if (now.state == LinkState::kEnded && !stop_)
    throw Raised({"the host", "ended: " + now.farewell, "Join again when it is back"});
}

void RemoteProgram::leave() {
  const py::gil_scoped_release released;
  stop_ = true;
  visit_->stop();
  if (loop_.joinable()) loop_.join();
}

}  // namespace slosh::python
