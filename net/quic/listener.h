// A host's endpoint: one socket, many connections, nothing kept before an address is known to be real.
#pragma once

#include <deque>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "net/quic/endpoint_base.h"
#include "net/quic/handshake_budget.h"

namespace slosh::quic {

class Listener final : public EndpointBase {
 public:
  Listener(std::unique_ptr<UdpSocket> socket, const Identity& identity, EndpointEvents& events,
           const EndpointOptions& options);
  ~Listener() override;
  void admit(ConnectionId connection) override;
  void set_known_keys(std::function<bool(const KeyFingerprint&)> known) override {
    known_ = std::move(known);
  }

 private:
  /// A connection that is over: what to answer to those who have not heard.
  struct Tombstone {
    std::vector<std::uint8_t> packet;
    Address remote;
    std::vector<std::string> ids;
    std::int64_t until = 0;
    unsigned answers_left = 0;
  };

  void packet_arrived(UdpSocket& socket, const Arrival& packet, std::int64_t now) override;
  void connection_over(Connection& connection, std::int64_t now) override;
  std::int64_t housekeeping(std::int64_t now) override;
  void confirmed(Connection& connection) override;
  void id_issued(Connection& connection, const ngtcp2_cid& id) override;
  void id_retired(Connection& connection, const ngtcp2_cid& id) override;

  void unknown_packet(UdpSocket& socket, const Arrival& packet, const ngtcp2_version_cid& ids,
                      std::int64_t now);
  void first_packet(UdpSocket& socket, const Arrival& packet, std::int64_t now);
  bool token_valid(const ngtcp2_pkt_hd& header, const Arrival& packet, std::int64_t now, FirstPacket& first);
  void accept(UdpSocket& socket, const Arrival& packet, const FirstPacket& first, std::int64_t now);
  void answer_retry(UdpSocket& socket, const Arrival& packet, const ngtcp2_pkt_hd& header, std::int64_t now);
  void answer_version(UdpSocket& socket, const Arrival& packet, const ngtcp2_version_cid& ids,
                      std::int64_t now);
  void answer_reset(UdpSocket& socket, const Arrival& packet, const ngtcp2_version_cid& ids,
                    std::int64_t now);
  void answer_full(UdpSocket& socket, const Arrival& packet, const FirstPacket& first);
  /// Whether one more stranger may be kept; may end another's connection for it.
  bool make_room(std::int64_t now);
  /// Whether one more answer to an unknown sender is within what we spend on those.
  bool may_answer(std::int64_t now);

  std::array<std::uint8_t, 32> token_secret_;
  std::unordered_map<std::string, Connection*> routes_;
  std::unordered_map<std::string, std::shared_ptr<Tombstone>> tombstones_;
  std::deque<std::shared_ptr<Tombstone>> tombstones_by_age_;
  std::unordered_set<std::string> used_tokens_;  // by the id that came with each
  std::deque<std::pair<std::int64_t, std::string>> used_by_age_;
  HandshakeBudget budget_;
  std::function<bool(const KeyFingerprint&)> known_;
  ConnectionId next_id_ = 1;
  double answers_left_;
  std::int64_t answers_at_ = 0;
};

}  // namespace slosh::quic
