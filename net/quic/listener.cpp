#include "net/quic/listener.h"

#include <algorithm>
#include <stdexcept>

#include "net/clock.h"
#include "net/random.h"

namespace slosh::quic {
namespace {

constexpr std::int64_t kTombstoneTime = kNanosecondsPerSecond;
constexpr std::size_t kTombstones = 1024;
constexpr std::int64_t kListenerHousekeeping = kNanosecondsPerSecond / 4;

std::string text_of(const ngtcp2_cid& id) {
  return {reinterpret_cast<const char*>(id.data), id.datalen};
}

}  // namespace

Listener::Listener(std::unique_ptr<UdpSocket> socket, const Identity& identity, EndpointEvents& events,
                   const EndpointOptions& options)
    : EndpointBase(identity, {}, events, options),
      budget_(options.handshakes_per_second, options.handshakes_in_all),
      answers_left_(0.0) {
  fill_random(token_secret_);
  sockets_.push_back(std::move(socket));
}

Listener::~Listener() {
  finish_all("the host ended");
  connections_.clear();
}

void Listener::packet_arrived(UdpSocket& socket, const Arrival& packet, std::int64_t now) {
  ngtcp2_version_cid ids{};
  const int code = ngtcp2_pkt_decode_version_cid(&ids, packet.bytes.data(), packet.bytes.size(), kCidSize);
  if (code == NGTCP2_ERR_VERSION_NEGOTIATION) return answer_version(socket, packet, ids, now);
  if (code != 0) {
    ++counts_.packets_ignored;
    return;
  }
  const std::string id(reinterpret_cast<const char*>(ids.dcid), ids.dcidlen);
  const auto route = routes_.find(id);
  if (route == routes_.end()) return unknown_packet(socket, packet, ids, now);
  Connection& connection = *route->second;
  connection.receive(packet.to, packet.from, packet.bytes, now);
  touch(connection);
}

void Listener::unknown_packet(UdpSocket& socket, const Arrival& packet, const ngtcp2_version_cid& ids,
                              std::int64_t now) {
  const auto grave = tombstones_.find(std::string(reinterpret_cast<const char*>(ids.dcid), ids.dcidlen));
  if (grave != tombstones_.end()) {
    Tombstone& found = *grave->second;
    if (found.answers_left > 0 && found.remote == packet.from && !found.packet.empty()) {
      --found.answers_left;
      const auto out = socket.space();
      if (out.empty()) return;
      std::copy(found.packet.begin(), found.packet.end(), out.begin());
      socket.add(packet.to, packet.from, found.packet.size());
    }
    return;
  }
  if (ids.version == 0) return answer_reset(socket, packet, ids, now);
  first_packet(socket, packet, now);
}

void Listener::confirmed(Connection& connection) {
  announce(connection, next_id_++);
  // Their key is known before they say anything. Once beside the connection that they may have lost: not as
  // often as they like.
  const auto same = std::count_if(connections_.begin(), connections_.end(), [&](const auto& other) {
    return other->admitted && other->state() != Connection::State::kClosed &&
           other->key() == connection.key();
  });
  connection.admitted = same < 2 && known_ && known_(connection.key());
  events_.on_connected(connection.id, connection.key(), connection.remote().text());
}

void Listener::connection_over(Connection& connection, std::int64_t now) {
  auto grave = std::make_shared<Tombstone>();
  for (const ngtcp2_cid& id : connection.ids()) {
    const std::string text = text_of(id);
    const auto route = routes_.find(text);
    if (route == routes_.end() || route->second != &connection) continue;
    routes_.erase(route);
    grave->ids.push_back(text);
  }
  // Late packets of a connection that is over get its last word again, or silence: not a new start.
  grave->packet = connection.close_packet();
  grave->remote = connection.remote();
  grave->until = now + kTombstoneTime;
  grave->answers_left = 4;
  for (const std::string& id : grave->ids) tombstones_[id] = grave;
  tombstones_by_age_.push_back(std::move(grave));
  if (connection.announced())
    events_.on_closed(connection.id, connection.reason());
  else
    ++counts_.handshakes_failed;
}

std::int64_t Listener::housekeeping(std::int64_t now) {
  while (!tombstones_by_age_.empty() &&
         (tombstones_by_age_.front()->until <= now || tombstones_by_age_.size() > kTombstones)) {
    for (const std::string& id : tombstones_by_age_.front()->ids) tombstones_.erase(id);
    tombstones_by_age_.pop_front();
  }
  while (!used_by_age_.empty() && used_by_age_.front().first <= now) {
    used_tokens_.erase(used_by_age_.front().second);
    used_by_age_.pop_front();
  }
  const bool idle = tombstones_by_age_.empty() && used_by_age_.empty();
  return idle ? now + 4 * kListenerHousekeeping : now + kListenerHousekeeping;
}

void Listener::id_issued(Connection& connection, const ngtcp2_cid& id) {
  routes_[text_of(id)] = &connection;
}

void Listener::id_retired(Connection&, const ngtcp2_cid& id) {
  routes_.erase(text_of(id));
}

void Listener::admit(ConnectionId id) {
  Connection* connection = find(id);
  if (!connection) return;
  connection->admitted = true;
  budget_.admitted(connection->site, now());
}

bool Listener::make_room(std::int64_t now) {
  std::size_t alive = 0;
  std::unordered_map<std::string_view, std::size_t> strangers;  // by site
  std::size_t all = 0;
  for (const auto& connection : connections_) {
    if (connection->state() == Connection::State::kClosed) continue;
    ++alive;
    if (connection->admitted) continue;
    ++strangers[connection->site];
    ++all;
  }
  if (alive < options_.max_connections && all < options_.max_strangers) return true;
  if (all == 0) return false;
  // Who knocks often only displaces himself; where all have knocked as often, who has waited longest goes.
  Connection* out = nullptr;
  for (const auto& connection : connections_) {
    if (connection->state() == Connection::State::kClosed || connection->admitted) continue;
    const std::size_t mine = strangers[connection->site], his = out ? strangers[out->site] : 0;
    if (mine > his || (mine == his && connection->began() < out->began())) out = connection.get();
  }
  out->put_off("the host is busy: too many are knocking", now);
  touch(*out);
  ++counts_.strangers_put_out;
  return true;
}

void Listener::accept(UdpSocket& socket, const Arrival& packet, const FirstPacket& first, std::int64_t now) {
  auto made = Connection::from_client(*this, tls_, options_, socket, packet.to, packet.from, first, now);
  if (!made) {
    ++counts_.packets_ignored;
    return;
  }
  Connection& connection = *made;
  connection.site = packet.from.site();
  connection.receive(packet.to, packet.from, packet.bytes, now);
  if (connection.state() == Connection::State::kClosed && connection.close_packet().empty()) {
    // Damaged on its way: the true one may still come with this token.
    for (const ngtcp2_cid& id : connection.ids()) routes_.erase(text_of(id));
    ++counts_.packets_ignored;
    return;
  }
  for (const ngtcp2_cid& id : connection.ids()) routes_[text_of(id)] = &connection;
  const std::string used = text_of(first.retry_id);
  used_tokens_.insert(used);
  used_by_age_.emplace_back(now + 10 * kNanosecondsPerSecond, used);
  adopt(std::move(made));
}

}  // namespace slosh::quic

namespace slosh {

namespace {

Result<std::unique_ptr<quic::UdpSocket>> socket_at(const std::string& address) {
  const auto found = quic::resolve(address);
  if (!found) return found.error();
  return quic::UdpSocket::listen(found.value().front());
}

}  // namespace

Result<bool> can_listen(const std::string& address) {
  const auto socket = socket_at(address);
  if (!socket) return socket.error();
  return true;
}

Result<std::unique_ptr<Endpoint>> listen_quic(const std::string& address, const Identity& identity,
                                              EndpointEvents& events, const EndpointOptions& options) {
  auto socket = socket_at(address);
  if (!socket) return socket.error();
  try {
    return std::unique_ptr<Endpoint>(
        std::make_unique<quic::Listener>(std::move(socket.value()), identity, events, options));
  } catch (const std::runtime_error& fault) {
    return Error{"encryption", fault.what(), quic::kTlsMend};
  }
}

}  // namespace slosh
