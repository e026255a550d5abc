// How a peer's connection begins, is lost and comes back: a part of RemoteLink.
#include <algorithm>

#include "net/clock.h"
#include "peer/remote/remote_link.h"

namespace slosh {
namespace {

EndpointOptions endpoint_options(double answer_within) {
  EndpointOptions options;
  options.idle_timeout = std::max(4.0, answer_within);
  options.keep_alive = 0.5;
  options.handshake_timeout = answer_within;
  options.max_connections = 1;
  // A pose that waited is followed by newer ones, which repeat it: no more than a few are worth their time.
  options.queue_datagrams[static_cast<std::size_t>(Priority::kPose)] = 8;
  return options;
}

}  // namespace

void RemoteLink::drop_endpoint() {
  if (endpoint_ && connection_ != 0) note_traffic(now());
  earlier_received_ = status_.numbers.bytes_received;
  earlier_sent_ = status_.numbers.bytes_sent;
  std::unique_ptr<Endpoint> gone;
  {
    const std::lock_guard lock(endpoint_mutex_);
    gone = std::move(endpoint_);
  }
  connection_ = 0;
  control_ = -1;
}

void RemoteLink::try_to_connect(std::int64_t now_ns) {
  const bool first = before_live(step_);
  if (began_ns_ == 0) began_ns_ = now_ns;
  Result<std::unique_ptr<Endpoint>> made =
      connect_(*this, endpoint_options(first ? options_.answer_within : kRetryAnswer));
  if (!made) {
    // No way to send at all: no such address, no socket. While trying again that may be a cable.
    if (first) return end(made.error());
    advance(LinkEvent::kLost);
    return backoff_.failed(now_ns);
  }
  {
    const std::lock_guard lock(endpoint_mutex_);
    endpoint_ = std::move(made.value());
  }
  advance(LinkEvent::kDialled);
}

bool RemoteLink::advance(LinkEvent event) {
  const std::optional<LinkStep> next = next_step(step_, event);
  if (!next) return false;
  step_ = *next;
  step_ns_ = now();
  status_.state = state_of(step_);
  return true;
}

void RemoteLink::on_connected(ConnectionId connection, const KeyFingerprint&, const std::string&) {
  if (!advance(LinkEvent::kAnswered)) return;
  connection_ = connection;
  splitter_ = {};
  scene_bytes_.clear();
  // The scene of a welcome that was lost with its connection is of no world that is known.
  if (!greeting_.welcome && world_stage_ == WorldStage::kScene) world_stage_ = WorldStage::kNone;
  greeting_ = {};
  requests_.clear();
  grips_tried_.clear();
  clock_.restart();
  pings_.restart(step_ns_);
  if (inbox_) inbox_->restart();
  if (world_.maker) world_.maker->restart();
  say_hello();
}

void RemoteLink::on_closed(ConnectionId, const CloseReason& reason) {
  close_due_ = reason;
  // A refusal whose message was lost with the connection is in the code all the same.
  if (step_ == LinkStep::kEnded || !reason.by_peer || reason.code == 0 || reason.code > wire::kRefusalCodes)
    return;
  const auto code = static_cast<wire::RefusalCode>(reason.code - 1);
  if (code == wire::RefusalCode::kBusy) close_due_->cause = CloseCause::kBusy;
  refused(code, reason.text);
}

/// Contact is gone (or never was): ends the link when it had not been live, else tries again.
void RemoteLink::lost(const CloseReason& why) {
  const LinkStep before = step_;
  if (before_live(before)) {
    const bool busy = why.cause == CloseCause::kBusy;
    if (busy && to_seconds(now() - began_ns_) < kBusyPatience && advance(LinkEvent::kBusy)) {
      if (busy_tries_++ == 0) notice("the host is busy (" + why.text + "); trying again");
      backoff_.failed(step_ns_);
      return publish(step_ns_);
    }
    const bool silent = why.cause == CloseCause::kNoAnswer || why.cause == CloseCause::kTimedOut;
    // The transport's own words name the address that did not answer.
    const bool named = why.cause == CloseCause::kNoAnswer && !why.text.empty();
    std::string what = why.text;
    if (what.empty())
      what = before == LinkStep::kJoining ? "the connection ended while joining" : "no answer within 5 s";
    return end(Error{named ? "" : options_.address, what,
                     busy                           ? "Join again in a while, with the same link"
                     : before == LinkStep::kJoining ? "Join again with the same link"
                     : silent ? "See that the host runs, and that UDP reaches that address and port"
                              : "Ask the host for a new link"});
  }
  if (!advance(LinkEvent::kLost)) return;
  if (before == LinkStep::kLive) {
    status_.lost_ns = step_ns_;
    grips_had_.clear();
    for (std::size_t i = 0; i < status_.held.size(); ++i) {
      if (status_.held[i]) grips_had_.push_back(static_cast<std::uint32_t>(i));
    }
    backoff_.lost(step_ns_);
    notice("contact with the host was lost (" +
           (why.text.empty() ? std::string("no reason given") : why.text) + "); trying to come back");
  } else {
    backoff_.failed(step_ns_);
  }
  publish(step_ns_);
}

void RemoteLink::leave(const std::string& words) {
  if (step_ == LinkStep::kEnded) return;
  if (!endpoint_ || connection_ == 0) return end(std::nullopt);
  wire::Bye bye;
  bye.reason = words;
  say(bye);
  endpoint_->close(connection_, 0, words);
  const std::int64_t until_ns = now() + to_nanoseconds(0.3);
  while (!options_.now && !close_due_ && now() < until_ns) endpoint_->run_once(until_ns);
  end(std::nullopt);
}

void RemoteLink::end(std::optional<Error> error, const std::string& farewell) {
  advance(LinkEvent::kEnd);
  status_.error = std::move(error);
  status_.farewell = farewell;
  publish(now());
}

}  // namespace slosh
