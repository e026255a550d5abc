// What a host's and a peer's endpoint share: the loop, the timers, the connections' life.
#pragma once

#include <memory>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "net/quic/connection.h"
#include "net/quic/endpoint.h"

namespace slosh::quic {

class EndpointBase : public Endpoint, protected ConnectionOwner {
 public:
  ~EndpointBase() override;
  void run_once(std::int64_t deadline_ns) override;
  void wake() override;
  bool send_datagram(ConnectionId connection, Priority priority, SharedBytes bytes) override;
  std::int64_t open_stream(ConnectionId connection, bool both_ways) override;
  bool send_stream(ConnectionId connection, std::int64_t stream, std::span<const std::uint8_t> bytes,
                   bool end) override;
  bool send_shared(ConnectionId id, std::int64_t stream, SharedBytes bytes, bool end) override;
  void close(ConnectionId connection, std::uint64_t code, const std::string& text) override;
  ConnectionStats stats(ConnectionId connection) const override;
  EndpointStats endpoint_stats() const override;
  std::string local_address() const override;

 protected:
  EndpointBase(const Identity& identity, TlsOddity oddity, EndpointEvents& events,
               const EndpointOptions& options);

  virtual void packet_arrived(UdpSocket& socket, const Arrival& packet, std::int64_t now) = 0;
  /// `connection` is closed and goes away after this.
  virtual void connection_over(Connection& connection, std::int64_t now) = 0;
  /// Something that is due now and then; when next, steady clock ns.
  virtual std::int64_t housekeeping(std::int64_t now) = 0;

  std::int64_t now() const;
  Connection& adopt(std::unique_ptr<Connection> connection);
  void touch(Connection& connection);
  Connection* find(ConnectionId id) const;
  void announce(Connection& connection, ConnectionId id);
  void finish_all(const std::string& text);
  void housekeeping_now() { next_housekeeping_ = 0; }

  // ConnectionOwner
  void stream_arrived(Connection& connection, std::int64_t stream, std::span<const std::uint8_t> bytes,
                      bool end) override;
  void datagram_arrived(Connection& connection, std::span<const std::uint8_t> bytes) override;
  void path_changed(Connection& connection, const Address& remote) override;
  bool reset_token(const ngtcp2_cid& id, std::uint8_t* token) override;

  EndpointEvents& events_;
  const EndpointOptions options_;
  const TlsContext tls_;
  EndpointStats counts_;
  std::vector<std::unique_ptr<UdpSocket>> sockets_;
  std::vector<std::unique_ptr<Connection>> connections_;

 private:
  void wait(std::int64_t until);
  void receive();
  void run_timers(std::int64_t now);
  void flush_dirty(std::int64_t now);
  void reap(std::int64_t now);
  void retime(Connection& connection);

  int wake_descriptor_;
  std::unordered_map<ConnectionId, Connection*> announced_;
  std::set<std::pair<std::int64_t, Connection*>> timers_;
  std::vector<Connection*> dirty_;
  std::int64_t next_housekeeping_ = 0;
  std::array<std::uint8_t, 32> reset_secret_;
};

}  // namespace slosh::quic
