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
  const bool first = status_.state == LinkState::kConnecting;
  if (began_ns_ == 0) began_ns_ = now_ns;
  Result<std::unique_ptr<Endpoint>> made =
      connect_(*this, endpoint_options(first ? options_.answer_within : kRetryAnswer));
  if (!made) {
    // No way to send at all: no such address, no socket. While trying again that may be a cable.
    if (first) return end(made.error());
    return backoff_.failed(now_ns);
  }
  {
    const std::lock_guard lock(endpoint_mutex_);
    endpoint_ = std::move(made.value());
  }
  phase_ = Phase::kConnecting;
  phase_ns_ = now_ns;
}

void RemoteLink::on_connected(ConnectionId connection, const KeyFingerprint&, const std::string&) {
  connection_ = connection;
  phase_ = Phase::kGreeting;
  phase_ns_ = now();
  splitter_ = {};
  scene_bytes_.clear();
  welcomed_ = roster_came_ = grips_asked_ = refused_ = false;
  requests_.clear();
  grips_tried_.clear();
  if (status_.state == LinkState::kConnecting) status_.state = LinkState::kJoining;
  clock_.restart();
  pings_.restart(phase_ns_);
  if (inbox_) inbox_->restart();
  if (world_.maker) world_.maker->restart();
  say_hello();
}

void RemoteLink::on_closed(ConnectionId, const CloseReason& reason) {
  closed_ = true;
  close_text_ = reason.text;
  close_cause_ = reason.cause;
  // A refusal whose message was lost with the connection is in the code all the same.
  if (!reason.by_peer || reason.code == 0 || reason.code > wire::kRefusalCodes || refused_) return;
  if (status_.state != LinkState::kEnded) {
    refused(static_cast<wire::RefusalCode>(reason.code - 1), reason.text);
  }
}

/// Contact is gone (or never was): ends the session when it had not begun, else tries again.
void RemoteLink::lost(const std::string& why, CloseCause cause) {
  const std::int64_t now_ns = now();
  phase_ = Phase::kIdle;
  if (leaving_) return end(std::nullopt);
  switch (status_.state) {
    case LinkState::kJoining:
      if (cause != CloseCause::kBusy)
        return end(Error{options_.address, why.empty() ? "the connection ended while joining" : why,
                         "Join again with the same link"});
      status_.state = LinkState::kConnecting;
      [[fallthrough]];
    case LinkState::kConnecting: {
      const bool silent = cause == CloseCause::kNoAnswer || cause == CloseCause::kTimedOut;
      if (cause == CloseCause::kBusy && to_seconds(now_ns - began_ns_) < kBusyPatience) {
        if (busy_tries_++ == 0) notice("the host is busy (" + why + "); trying again");
        backoff_.failed(now_ns);
        break;
      }
      std::string mend = "Ask the host for a new link";
      if (silent) mend = "See that the host runs, and that UDP reaches that address and port";
      if (cause == CloseCause::kBusy) mend = "Join again in a while, with the same link";
      const bool named = why.find(options_.address) != std::string::npos;
      return end(Error{named ? "" : options_.address, why, mend});
    }
    case LinkState::kLive:
      status_.state = LinkState::kReconnecting;
      status_.lost_ns = now_ns;
      grips_had_.clear();
      for (std::size_t i = 0; i < status_.held.size(); ++i) {
        if (status_.held[i]) grips_had_.push_back(static_cast<std::uint32_t>(i));
      }
      backoff_.lost(now_ns);
      notice("contact with the host was lost (" + (why.empty() ? std::string("no reason given") : why) +
             "); trying to come back");
      break;
    case LinkState::kReconnecting:
      backoff_.failed(now_ns);
      break;
    case LinkState::kEnded:
      return;
  }
  publish(now_ns);
}

void RemoteLink::leave(const std::string& words) {
  if (status_.state == LinkState::kEnded || leaving_) return;
  leaving_ = true;
  if (!endpoint_ || connection_ == 0) return end(std::nullopt);
  wire::Bye bye;
  bye.reason = words;
  say(bye);
  endpoint_->close(connection_, 0, words);
  const std::int64_t until_ns = now() + to_nanoseconds(0.3);
  while (!options_.now && !closed_ && now() < until_ns) endpoint_->run_once(until_ns);
  end(std::nullopt);
}

void RemoteLink::end(std::optional<Error> error, const std::string& farewell) {
  status_.state = LinkState::kEnded;
  status_.error = std::move(error);
  status_.farewell = farewell;
  phase_ = Phase::kIdle;
  publish(now());
}

}  // namespace slosh
