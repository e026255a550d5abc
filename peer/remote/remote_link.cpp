#include "peer/remote/remote_link.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "net/clock.h"

namespace slosh {
namespace {

constexpr double kWelcomeWithin = 10.0;  // s from the handshake to a live link
constexpr std::int64_t kPublishGap_ns = 50'000'000;
constexpr std::int64_t kLongestTurn_ns = 20'000'000;
constexpr std::int64_t kTrafficWindow_ns = 1'000'000'000;

}  // namespace

RemoteLink::RemoteLink(RemoteOptions options, Connect connect, RemoteShared& shared)
    : options_(std::move(options)),
      connect_(std::move(connect)),
      shared_(shared),
      backoff_(options_.patience) {}

RemoteLink::~RemoteLink() {
  drop_endpoint();
  if (world_.maker) world_.maker->finish();
}

std::int64_t RemoteLink::now() const {
  return options_.now ? options_.now() : steady_now_ns();
}

void RemoteLink::wake() {
  const std::lock_guard lock(endpoint_mutex_);
  if (endpoint_) endpoint_->wake();
}

bool RemoteLink::turn() {
  const std::int64_t now_ns = now();
  std::vector<RemoteCommand> commands;
  {
    const std::lock_guard lock(shared_.mutex);
    commands.swap(shared_.commands);
  }
  for (const RemoteCommand& command : commands) obey(command);
  const std::int64_t deadline_ns = work(now_ns);
  if (step_ == LinkStep::kEnded) return false;
  if (endpoint_) {
    endpoint_->run_once(deadline_ns);
  } else if (!options_.now) {
    sleep_until_ns(std::min(deadline_ns, now_ns + kLongestTurn_ns));
  }
  if (const std::optional<CloseReason> reason = std::exchange(close_due_, std::nullopt)) {
    drop_endpoint();
    lost(*reason);
  }
  if (inbox_) pump_bodies(now());
  return step_ != LinkStep::kEnded;
}

/// Everything that is due; tells when to come back.
std::int64_t RemoteLink::work(std::int64_t now_ns) {
  std::int64_t next_ns = now_ns + kLongestTurn_ns;
  const double in_step = to_seconds(now_ns - step_ns_);
  const auto give_up = [&](const char* why) {
    drop_endpoint();
    lost({false, 0, why, CloseCause::kTimedOut});
  };
  switch (step_) {
    case LinkStep::kIdle:
      if (now_ns >= backoff_.due_ns()) try_to_connect(now_ns);
      next_ns = std::min(next_ns, backoff_.due_ns());
      break;
    case LinkStep::kWaiting:
      if (backoff_.gave_up(now_ns)) {
        end(Error{options_.address, "contact was lost and did not come back",
                  "Join again with the same link"});
        return now_ns;
      }
      if (now_ns >= backoff_.due_ns()) try_to_connect(now_ns);
      next_ns = std::min(next_ns, backoff_.due_ns());
      break;
    case LinkStep::kDialling:
      // The transport has the same patience, and better words: it is heard first.
      if (in_step > options_.answer_within + 0.25) give_up("");
      break;
    case LinkStep::kRedialling:
      if (in_step > kRetryAnswer) give_up("");
      break;
    case LinkStep::kJoining:
    case LinkStep::kRejoining:
      go_live_if_ready(now_ns);
      if (in_contact(step_) && step_ != LinkStep::kLive && in_step > kWelcomeWithin)
        give_up("the host answered and then said nothing");
      break;
    case LinkStep::kLive:
    case LinkStep::kEnded:
      break;
  }
  if (in_contact(step_) && endpoint_) {
    if (now_ns >= pings_.due_ns()) ping(now_ns);
    next_ns = std::min(next_ns, pings_.due_ns());
    if (inbox_) {
      pump_bodies(now_ns);
      next_ns = std::min(next_ns, inbox_->next_due_ns(clock_));
    }
    if (uplink_ && std::find(status_.held.begin(), status_.held.end(), true) != status_.held.end()) {
      if (now_ns >= pose_due_ns_) {
        // On a grid, but what was missed is not made up for.
        pose_due_ns_ = std::max(pose_due_ns_ + kPoseGap_ns, now_ns);
        if (SharedBytes poses = uplink_->make(status_.held, agreed_)) send(Priority::kPose, std::move(poses));
      }
      next_ns = std::min(next_ns, pose_due_ns_);
    }
    if (world_.maker) {
      for (SharedBytes& feedback : world_.maker->take_feedback()) send(Priority::kState, std::move(feedback));
    }
  }
  if (now_ns >= publish_due_ns_) publish(now_ns);
  return std::max(next_ns, now_ns);
}

void RemoteLink::pump_bodies(std::int64_t now_ns) {
  const BodyMessage* const state = inbox_->next(now_ns, clock_);
  if (state == nullptr || !world_.channel) return;
  world_.channel->bodies().back() = *state;
  world_.channel->bodies().publish();
  world_.maker->note_bodies(*state);
}

/// To the device loop at once, with when the readings were read that the state answers to.
void RemoteLink::pass_newest(const BodyMessage& state) {
  if (!world_.channel || !uplink_) return;
  BodyMessage& out = world_.channel->newest().back();
  out = state;
  uplink_->resolve(out, status_.held);
  world_.channel->newest().publish();
}

void RemoteLink::send(Priority priority, SharedBytes bytes) {
  (void)endpoint_->send_datagram(connection_, priority, std::move(bytes));
}

void RemoteLink::ping(std::int64_t now_ns) {
  wire::ClockPing message;
  message.number = next_ping_++;
  message.sent_ns = now_ns;
  pings_sent_[message.number % pings_sent_.size()] = {message.number, now_ns};
  send(Priority::kPose, std::make_shared<const std::vector<std::uint8_t>>(wire::datagram(message)));
  pings_.sent(now_ns);
}

void RemoteLink::on_stream(ConnectionId, std::int64_t stream, std::span<const std::uint8_t> bytes,
                           bool end_of_stream) {
  if (step_ == LinkStep::kEnded) return;
  if (stream != control_) return take_scene(bytes, end_of_stream);
  const wire::Fault fault = splitter_.feed(
      bytes, [this](std::uint64_t type, wire::ByteView payload) { return receive(type, payload); });
  if (fault && step_ != LinkStep::kEnded) bad_host(fault, "a message");
}

void RemoteLink::on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || step_ == LinkStep::kEnded) return;
  const std::int64_t now_ns = now();
  const wire::ByteView payload = bytes.subspan(1);
  switch (static_cast<wire::DatagramType>(bytes[0])) {
    case wire::DatagramType::kClockPong: {
      wire::ClockPong pong;
      if (wire::decode(payload, pong)) break;
      PingSent& sent = pings_sent_[pong.number % pings_sent_.size()];
      // By our own note of when it went out, and once only.
      if (pong.number == 0 || sent.number != pong.number) return;
      sent.number = 0;
      (void)clock_.add(sent.sent_ns, pong.received_ns, pong.sent_ns, now_ns);
      if (world_.maker) world_.maker->note_clock(clock_);
      return;
    }
    case wire::DatagramType::kBodies: {
      wire::Bodies bodies;
      if (wire::decode(payload, bodies, agreed_)) break;
      // Before the clock is known nothing can be said of when a state belongs.
      if (!inbox_ || !clock_.known()) return;
      inbox_->take(bodies, now_ns, clock_);
      if (const BodyMessage* const newest = inbox_->newest()) pass_newest(*newest);
      if (world_.maker) world_.maker->note_moment(inbox_->moment());
      return;
    }
    case wire::DatagramType::kFluidWrench: {
      wire::FluidWrench model;
      if (wire::decode(payload, model)) break;
      if (inbox_) inbox_->take(model);
      return;
    }
    case wire::DatagramType::kSnapshotPiece:
      if (world_.maker) world_.maker->offer(bytes);
      return;
    case wire::DatagramType::kHands: {
      // To be drawn: the device loop couples to the bodies alone.
      wire::Hands hands;
      if (wire::decode(payload, hands)) break;
      if (!inbox_ || !world_.maker || !clock_.known() || !inbox_->moment().known) return;
      const WorldMoment& moment = inbox_->moment();
      for (const wire::HandEntry& hand : hands.hands)
        world_.maker->note_hand(moment.run, hand.grip, moment.time_at(hand.received_ns), hand.pose,
                                hand.engaged);
      return;
    }
    default:
      break;
  }
  status_.numbers.bad_datagrams += 1;
}

void RemoteLink::note_traffic(std::int64_t now_ns) {
  LinkNumbers& numbers = status_.numbers;
  if (endpoint_ && connection_ != 0) {
    const ConnectionStats stats = endpoint_->stats(connection_);
    numbers.round_trip = stats.smoothed_rtt > 0.0 ? stats.smoothed_rtt : clock_.round_trip();
    // A connection that is closing has no numbers any more: what was known stays.
    numbers.bytes_received = std::max(numbers.bytes_received, earlier_received_ + stats.bytes_received);
    numbers.bytes_sent = std::max(numbers.bytes_sent, earlier_sent_ + stats.bytes_sent);
    std::uint64_t sent = 0;
    for (const std::uint64_t each : stats.datagrams_sent) sent += each;
    if (sent > 0) numbers.send_loss = static_cast<double>(stats.datagrams_lost) / static_cast<double>(sent);
  }
  if (now_ns - traffic_ns_ > kTrafficWindow_ns) {
    numbers.receive_rate =
        static_cast<double>(numbers.bytes_received - std::min(traffic_bytes_, numbers.bytes_received)) /
        to_seconds(now_ns - traffic_ns_);
    traffic_ns_ = now_ns;
    traffic_bytes_ = numbers.bytes_received;
  }
}

void RemoteLink::publish(std::int64_t now_ns) {
  publish_due_ns_ = now_ns + kPublishGap_ns;
  note_traffic(now_ns);
  LinkNumbers& numbers = status_.numbers;
  numbers.clock_error = clock_.known() ? clock_.error_bound(now_ns) : 0.0;
  numbers.clock_steps = clock_.steps();
  if (inbox_) {
    numbers.body_delay = inbox_->delay();
    numbers.bodies = inbox_->counts();
    status_.moment = inbox_->moment();
    if (status_.moment.known) status_.world_time = status_.moment.time_at(clock_.to_host(now_ns));
  }
  if (uplink_) numbers.poses = uplink_->numbered();
  {
    const std::lock_guard lock(shared_.mutex);
    shared_.status = status_;
  }
  shared_.changed.notify_all();
}

}  // namespace slosh
