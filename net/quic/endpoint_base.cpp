#include "net/quic/endpoint_base.h"

#include <gnutls/crypto.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "net/clock.h"

namespace slosh::quic {
namespace {

constexpr int kBatchesAtOnce = 16;  // receive batches before timers and sending get their turn

/// The same for the same key: a host that starts anew can tell old peers that it has forgotten them.
std::array<std::uint8_t, 32> reset_secret(const Identity& identity) {
  std::vector<std::uint8_t> key = identity.private_key();
  constexpr char kPurpose[] = "slosh stateless reset";
  std::array<std::uint8_t, 32> secret{};
  gnutls_hmac_fast(GNUTLS_MAC_SHA256, key.data(), key.size(), kPurpose, sizeof(kPurpose), secret.data());
  gnutls_memset(key.data(), 0, key.size());
  return secret;
}

}  // namespace

EndpointBase::EndpointBase(const Identity& identity, TlsOddity oddity, EndpointEvents& events,
                           const EndpointOptions& options)
    : events_(events),
      options_(options),
      tls_(identity, std::move(oddity)),
      wake_descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      reset_secret_(reset_secret(identity)) {}

EndpointBase::~EndpointBase() {
  connections_.clear();
  ::close(wake_descriptor_);
}

std::int64_t EndpointBase::now() const {
  return options_.clock ? options_.clock() : steady_now_ns();
}

void EndpointBase::finish_all(const std::string& text) {
  const std::int64_t now = this->now();
  for (const auto& connection : connections_) connection->abort(0, text, now);
  for (const auto& socket : sockets_) socket->flush();
}

void EndpointBase::run_once(std::int64_t deadline_ns) {
  std::int64_t now = this->now();
  flush_dirty(now);
  reap(now);
  std::int64_t until = std::min(deadline_ns, next_housekeeping_);
  if (!timers_.empty()) until = std::min(until, timers_.begin()->first);
  wait(until);
  receive();
  now = this->now();
  run_timers(now);
  if (now >= next_housekeeping_) next_housekeeping_ = housekeeping(now);
  flush_dirty(now);
  reap(now);
}

void EndpointBase::wait(std::int64_t until) {
  std::vector<pollfd> descriptors;
  descriptors.push_back({wake_descriptor_, POLLIN, 0});
  bool blocked = false;
  for (const auto& socket : sockets_) {
    const bool full = socket->blocked();
    blocked = blocked || full;
    descriptors.push_back({socket->descriptor(), static_cast<short>(full ? POLLIN | POLLOUT : POLLIN), 0});
  }
  const std::int64_t now = this->now();
  // While the kernel takes nothing, timers that want to send cannot do anything about it.
  if (blocked) until = std::max(until, now + 1'000'000);
  const std::int64_t left = options_.clock ? 0 : std::max<std::int64_t>(until - now, 0);
  timespec timeout{};
  timeout.tv_sec = static_cast<time_t>(std::min<std::int64_t>(left / kNanosecondsPerSecond, 3600));
  timeout.tv_nsec = static_cast<long>(left % kNanosecondsPerSecond);
  if (ppoll(descriptors.data(), descriptors.size(), &timeout, nullptr) <= 0) return;
  if (descriptors[0].revents & POLLIN) {
    std::uint64_t count = 0;
    while (read(wake_descriptor_, &count, sizeof(count)) < 0 && errno == EINTR) {
    }
  }
  for (std::size_t i = 0; i < sockets_.size(); ++i)
    if (descriptors[i + 1].revents & POLLOUT) {
      sockets_[i]->flush();
      for (const auto& connection : connections_)
        if (&connection->socket() == sockets_[i].get()) touch(*connection);
    }
}

void EndpointBase::receive() {
  for (std::size_t i = 0; i < sockets_.size(); ++i) {
    for (int batch = 0; batch < kBatchesAtOnce; ++batch) {
      const auto packets = sockets_[i]->receive();
      const std::int64_t now = this->now();
      for (const Arrival& packet : packets) packet_arrived(*sockets_[i], packet, now);
      if (packets.empty()) break;
    }
  }
}

void EndpointBase::run_timers(std::int64_t now) {
  std::vector<Connection*> due;
  for (auto it = timers_.begin(); it != timers_.end() && it->first <= now; ++it) due.push_back(it->second);
  for (Connection* connection : due) {
    connection->expire(now);
    touch(*connection);
  }
}

void EndpointBase::touch(Connection& connection) {
  if (connection.dirty) return;
  connection.dirty = true;
  dirty_.push_back(&connection);
}

void EndpointBase::flush_dirty(std::int64_t now) {
  std::vector<Connection*> turn;
  turn.swap(dirty_);
  for (Connection* connection : turn) {
    connection->dirty = false;
    connection->flush(now);
    retime(*connection);
  }
  for (const auto& socket : sockets_)
    if (!socket->blocked()) socket->flush();
}

void EndpointBase::retime(Connection& connection) {
  const std::int64_t due = connection.expiry();
  if (due == connection.timer) return;
  timers_.erase({connection.timer, &connection});
  connection.timer = due;
  if (due != INT64_MAX) timers_.insert({due, &connection});
}

void EndpointBase::reap(std::int64_t now) {
  // Telling of one end may close others: they are found in the next round.
  for (std::size_t i = 0; i < connections_.size();) {
    if (connections_[i]->state() != Connection::State::kClosed) {
      ++i;
      continue;
    }
    const std::unique_ptr<Connection> over = std::move(connections_[i]);
    connections_[i] = std::move(connections_.back());
    connections_.pop_back();
    timers_.erase({over->timer, over.get()});
    std::erase(dirty_, over.get());
    if (over->announced() || over->id != 0) announced_.erase(over->id);
    connection_over(*over, now);
  }
}

Connection& EndpointBase::adopt(std::unique_ptr<Connection> connection) {
  connections_.push_back(std::move(connection));
  touch(*connections_.back());
  return *connections_.back();
}

void EndpointBase::announce(Connection& connection, ConnectionId id) {
  connection.id = id;
  announced_[id] = &connection;
}

Connection* EndpointBase::find(ConnectionId id) const {
  const auto it = announced_.find(id);
  return it == announced_.end() ? nullptr : it->second;
}

void EndpointBase::wake() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(wake_descriptor_, &one, sizeof(one));
}

bool EndpointBase::send_datagram(ConnectionId id, Priority priority, SharedBytes bytes) {
  Connection* connection = find(id);
  if (!connection || !connection->send_datagram(priority, std::move(bytes))) return false;
  touch(*connection);
  return true;
}

std::int64_t EndpointBase::open_stream(ConnectionId id, bool both_ways) {
  Connection* connection = find(id);
  return connection ? connection->open_stream(both_ways) : -1;
}

bool EndpointBase::send_stream(ConnectionId id, std::int64_t stream, std::span<const std::uint8_t> bytes,
                               bool end) {
  Connection* connection = find(id);
  if (!connection || !connection->send_stream(stream, bytes, end)) return false;
  touch(*connection);
  return true;
}

bool EndpointBase::send_shared(ConnectionId id, std::int64_t stream, SharedBytes bytes, bool end) {
  Connection* connection = find(id);
  if (!connection || !connection->send_shared(stream, std::move(bytes), end)) return false;
  touch(*connection);
  return true;
}

void EndpointBase::close(ConnectionId id, std::uint64_t code, const std::string& text) {
  Connection* connection = find(id);
  if (!connection) return;
  connection->close(code, text, now());
  touch(*connection);
}

ConnectionStats EndpointBase::stats(ConnectionId id) const {
  const Connection* connection = find(id);
  return connection ? connection->stats() : ConnectionStats{};
}

EndpointStats EndpointBase::endpoint_stats() const {
  EndpointStats stats = counts_;
  stats.connections = connections_.size();
  for (const auto& connection : connections_) stats.strangers += connection->admitted ? 0 : 1;
  return stats;
}

std::string EndpointBase::local_address() const {
  return sockets_.empty() ? "nowhere" : sockets_.front()->local().text();
}

void EndpointBase::stream_arrived(Connection& connection, std::int64_t stream,
                                  std::span<const std::uint8_t> bytes, bool end) {
  events_.on_stream(connection.id, stream, bytes, end);
}

void EndpointBase::datagram_arrived(Connection& connection, std::span<const std::uint8_t> bytes) {
  events_.on_datagram(connection.id, bytes);
}

void EndpointBase::path_changed(Connection& connection, const Address& remote) {
  events_.on_migrated(connection.id, remote.text());
}

bool EndpointBase::reset_token(const ngtcp2_cid& id, std::uint8_t* token) {
  return ngtcp2_crypto_generate_stateless_reset_token(token, reset_secret_.data(), reset_secret_.size(),
                                                      &id) == 0;
}

}  // namespace slosh::quic
