// A peer's endpoint: tries all addresses of a host at once, keeps the first that answers with the right key.
#pragma once

#include "net/quic/endpoint_base.h"

namespace slosh::quic {

class Client final : public EndpointBase {
 public:
  /// Errors: no socket for any address.
  static Result<std::unique_ptr<Client>> connect(const std::vector<Address>& addresses,
                                                 const KeyFingerprint& host, const Identity& identity,
                                                 TlsOddity oddity, EndpointEvents& events,
                                                 const EndpointOptions& options);
  ~Client() override;

  bool rebind() override;
  void close(ConnectionId connection, std::uint64_t code, const std::string& text) override;
  std::string local_address() const override;

 private:
  static constexpr ConnectionId kOnly = 1;  // one connection an endpoint

  Client(const Identity& identity, TlsOddity oddity, EndpointEvents& events, const EndpointOptions& options);
  void packet_arrived(UdpSocket& socket, const Arrival& packet, std::int64_t now) override;
  void connection_over(Connection& connection, std::int64_t now) override;
  std::int64_t housekeeping(std::int64_t now) override;
  void move(std::int64_t now);
  void confirmed(Connection& connection) override;
  void id_issued(Connection&, const ngtcp2_cid&) override {}
  void id_retired(Connection&, const ngtcp2_cid&) override {}

  Connection* chosen_ = nullptr;
  bool over_ = false;
  CloseReason failure_;  // of the attempts, the one that tells most
  bool failure_definite_ = false;
  std::int64_t moved_at_ = 0;
  bool move_wanted_ = false;
};

}  // namespace slosh::quic

namespace slosh {

/// connect_quic() for tests: with a departure from the rules.
Result<std::unique_ptr<Endpoint>> connect_quic_oddly(const std::vector<std::string>& addresses,
                                                     const KeyFingerprint& host, const Identity& identity,
                                                     const quic::TlsOddity& oddity, EndpointEvents& events,
                                                     const EndpointOptions& options = {});

}  // namespace slosh
