#include "net/quic/client.h"

#include <algorithm>
#include <cerrno>
#include <stdexcept>

#include "net/clock.h"

namespace slosh::quic {
namespace {

constexpr std::size_t kAttempts = 8;
constexpr std::int64_t kHousekeeping = kNanosecondsPerSecond / 10;

/// Errors of sending that mean: this socket's address is of no use any more.
bool address_gone(int code) {
  return code == EADDRNOTAVAIL || code == ENETUNREACH || code == EHOSTUNREACH || code == ENETDOWN ||
         code == EINVAL || code == ENODEV;
}

}  // namespace

Client::Client(const Identity& identity, TlsOddity oddity, EndpointEvents& events,
               const EndpointOptions& options)
    : EndpointBase(identity, std::move(oddity), events, options) {}

Client::~Client() {
  finish_all("the peer ended");
  connections_.clear();
}

Result<std::unique_ptr<Client>> Client::connect(const std::vector<Address>& addresses,
                                                const KeyFingerprint& host, const Identity& identity,
                                                TlsOddity oddity, EndpointEvents& events,
                                                const EndpointOptions& options) {
  std::unique_ptr<Client> client(new Client(identity, std::move(oddity), events, options));
  const std::int64_t now = client->now();
  Error last{"link", "it names no address", "Ask the host for a new link"};
  for (const Address& address : addresses) {
    if (client->connections_.size() >= kAttempts) break;
    auto socket = UdpSocket::connect(address);
    if (!socket) {
      last = socket.error();
      continue;
    }
    auto made =
        Connection::to_host(*client, client->tls_, client->options_, *socket.value(), address, host, now);
    if (!made) return Error{address.text(), "no memory for a connection", ""};
    client->sockets_.push_back(std::move(socket.value()));
    client->adopt(std::move(made));
  }
  if (client->connections_.empty()) return last;
  return client;
}

void Client::packet_arrived(UdpSocket& socket, const Arrival& packet, std::int64_t now) {
  for (const auto& connection : connections_) {
    if (&connection->socket() != &socket) continue;
    connection->receive(packet.to, connection->remote(), packet.bytes, now);
    touch(*connection);
    return;
  }
  ++counts_.packets_ignored;
}

void Client::confirmed(Connection& connection) {
  if (chosen_ || over_) {
    connection.close(0, "another address was faster", now());
    return;
  }
  chosen_ = &connection;
  announce(connection, kOnly);
  for (const auto& other : connections_) {
    if (other.get() == chosen_) continue;
    other->close(0, "another address was faster", now());
    touch(*other);
  }
  events_.on_connected(kOnly, connection.key(), connection.remote().text());
}

void Client::connection_over(Connection& connection, std::int64_t) {
  const bool was_chosen = &connection == chosen_;
  if (!was_chosen) {
    if (!chosen_ && !over_ &&
        (failure_.text.empty() || (connection.refused_for_good() && !failure_definite_) ||
         (connection.reason().cause == CloseCause::kBusy && failure_.cause == CloseCause::kNoAnswer))) {
      failure_ = connection.reason();
      failure_definite_ = connection.refused_for_good();
    }
    ++counts_.handshakes_failed;
  }
  // Its socket has said its last word.
  UdpSocket* socket = &connection.socket();
  socket->flush();
  std::erase_if(sockets_, [&](const auto& mine) { return mine.get() == socket && sockets_.size() > 1; });
  if (over_) return;
  if (was_chosen) {
    chosen_ = nullptr;
    over_ = true;
    events_.on_closed(kOnly, connection.reason());
  } else if (!chosen_ && connections_.empty()) {
    over_ = true;
    events_.on_closed(kOnly, failure_);
  }
}

void Client::close(ConnectionId id, std::uint64_t code, const std::string& text) {
  if (id != kOnly || over_) return;
  if (chosen_) return EndpointBase::close(id, code, text);
  failure_ = {false, code, text};
  failure_definite_ = true;
  for (const auto& connection : connections_) {
    connection->close(code, text, now());
    touch(*connection);
  }
}

/// The network may leave without a word, or with an error on sending: a new socket gets the address of now.
std::int64_t Client::housekeeping(std::int64_t now) {
  if (chosen_ && chosen_->state() == Connection::State::kOpen) {
    // The host answers a keep-alive at once. Nothing for much longer: an address or a NAT's memory is gone.
    const double patience = std::max(1.5 * options_.keep_alive, 0.3) + 4.0 * chosen_->stats().smoothed_rtt;
    const bool silent = to_seconds(now - chosen_->last_received()) > patience;
    const bool failing = address_gone(chosen_->socket().send_error());
    const bool rested = to_seconds(now - moved_at_) > std::max(0.5, 0.5 * options_.keep_alive);
    if (move_wanted_ || ((silent || failing) && rested)) move(now);
  }
  return now + kHousekeeping;
}

/// An event may ask for it while the old socket's packets are still being read: it is done afterwards.
bool Client::rebind() {
  if (!chosen_ || chosen_->state() != Connection::State::kOpen) return false;
  move_wanted_ = true;
  housekeeping_now();
  return true;
}

void Client::move(std::int64_t now) {
  move_wanted_ = false;
  moved_at_ = now;
  auto socket = UdpSocket::connect(chosen_->remote());
  if (!socket) return;  // no network at all: tried again before long
  UdpSocket* old = &chosen_->socket();
  old->flush();
  chosen_->move_to(*socket.value(), now);
  std::erase_if(sockets_, [&](const auto& mine) { return mine.get() == old; });
  sockets_.push_back(std::move(socket.value()));
  touch(*chosen_);
}

std::string Client::local_address() const {
  if (chosen_) return chosen_->socket().local().text();
  return EndpointBase::local_address();
}

}  // namespace slosh::quic

namespace slosh {

Result<std::unique_ptr<Endpoint>> connect_quic_oddly(const std::vector<std::string>& addresses,
                                                     const KeyFingerprint& host, const Identity& identity,
                                                     const quic::TlsOddity& oddity, EndpointEvents& events,
                                                     const EndpointOptions& options) {
  std::vector<quic::Address> found;
  Error last{"link", "it names no address", "Ask the host for a new link"};
  for (const std::string& address : addresses) {
    auto some = quic::resolve(address);
    if (!some) {
      last = some.error();
      continue;
    }
    for (const quic::Address& one : some.value()) {
      if (one.port() == 0) {
        last = {"address '" + address + "'", "nobody can listen at port 0", "Give the host's port"};
      } else if (std::find(found.begin(), found.end(), one) == found.end()) {
        found.push_back(one);
      }
    }
  }
  if (found.empty()) return last;
  try {
    auto client = quic::Client::connect(found, host, identity, oddity, events, options);
    if (!client) return client.error();
    return std::unique_ptr<Endpoint>(std::move(client.value()));
  } catch (const std::runtime_error& fault) {
    return Error{"encryption", fault.what(), quic::kTlsMend};
  }
}

Result<std::unique_ptr<Endpoint>> connect_quic(const std::vector<std::string>& addresses,
                                               const KeyFingerprint& host, const Identity& identity,
                                               EndpointEvents& events, const EndpointOptions& options) {
  return connect_quic_oddly(addresses, host, identity, {}, events, options);
}

}  // namespace slosh
