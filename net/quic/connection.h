// One QUIC connection: ngtcp2, its TLS session, and what waits to be sent.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "net/quic/compat.h"
#include "net/quic/connection_memory.h"
#include "net/quic/datagram_queues.h"
#include "net/quic/delivered_rate.h"
#include "net/quic/endpoint.h"
#include "net/quic/loss_ledger.h"
#include "net/quic/pace.h"
#include "net/quic/pose_room.h"
#include "net/quic/snapshot_room.h"
#include "net/quic/stream_outbox.h"
#include "net/quic/tls.h"
#include "net/quic/udp_socket.h"

namespace slosh::quic {

class Connection;

constexpr std::size_t kCidSize = 10;  ///< bytes of the connection ids that we give out

/// The client's first stream, opened by the connection itself. Its bytes mean nothing: one in every packet of
/// datagrams makes the library ask again when no acknowledgement comes (kDatagramsAreProbed).
constexpr std::int64_t kProbeStream = 0;

/// What a connection tells the endpoint that it belongs to, from inside receive() and expire().
class ConnectionOwner {
 public:
  virtual void confirmed(Connection& connection) = 0;
  virtual void stream_arrived(Connection& connection, std::int64_t stream,
                              std::span<const std::uint8_t> bytes, bool end) = 0;
  virtual void datagram_arrived(Connection& connection, std::span<const std::uint8_t> bytes) = 0;
  virtual void path_changed(Connection& connection, const Address& remote) = 0;
  virtual void id_issued(Connection& connection, const ngtcp2_cid& id) = 0;
  virtual void id_retired(Connection& connection, const ngtcp2_cid& id) = 0;
  /// NGTCP2_STATELESS_RESET_TOKENLEN bytes that belong to `id`.
  virtual bool reset_token(const ngtcp2_cid& id, std::uint8_t* token) = 0;

 protected:
  ~ConnectionOwner() = default;
};

/// What a validated first packet says.
struct FirstPacket {
  ngtcp2_cid client_id;    ///< the client's, that we send to
  ngtcp2_cid original_id;  ///< that the client sent to before the Retry
  ngtcp2_cid retry_id;     ///< that the Retry gave it
  std::uint32_t version = 0;
  std::vector<std::uint8_t> token;
};

class Connection {
 public:
  enum class State : std::uint8_t { kHandshake, kOpen, kLingering, kClosed };

  /// Null when out of memory.
  static std::unique_ptr<Connection> to_host(ConnectionOwner& owner, const TlsContext& tls,
                                             const EndpointOptions& options, UdpSocket& socket,
                                             const Address& remote, const KeyFingerprint& host,
                                             std::int64_t now);
  static std::unique_ptr<Connection> from_client(ConnectionOwner& owner, const TlsContext& tls,
                                                 const EndpointOptions& options, UdpSocket& socket,
                                                 const Address& local, const Address& remote,
                                                 const FirstPacket& first, std::int64_t now);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void receive(const Address& local, const Address& remote, std::span<const std::uint8_t> packet,
               std::int64_t now);
  void expire(std::int64_t now);
  /// Writes what the window and the pace allow into the socket's batch.
  void flush(std::int64_t now);
  /// When expire() is due, steady clock ns; INT64_MAX = never.
  std::int64_t expiry() const;

  bool send_datagram(Priority priority, SharedBytes bytes);
  std::int64_t open_stream(bool both_ways);
  bool send_stream(std::int64_t stream, std::span<const std::uint8_t> bytes, bool end);
  bool send_shared(std::int64_t stream, SharedBytes bytes, bool end);
  /// Lets streams finish for a little while, then closes.
  void close(std::uint64_t code, const std::string& text, std::int64_t now);
  /// Closes without waiting for anything.
  void abort(std::uint64_t code, const std::string& text, std::int64_t now);
  /// The same, and the other side understands that it may try again (CloseCause::kBusy).
  void put_off(const std::string& text, std::int64_t now);
  /// Goes on over another socket, from now.
  void move_to(UdpSocket& socket, std::int64_t now);

  State state() const { return state_; }
  bool announced() const { return announced_; }  ///< confirmed() was called
  const CloseReason& reason() const { return reason_; }
  bool refused_for_good() const { return refused_for_good_; }  ///< trying again elsewhere is no use
  const KeyFingerprint& key() const { return *peer_.found; }
  ConnectionStats stats() const;
  const Address& remote() const { return remote_; }
  UdpSocket& socket() const { return *socket_; }
  std::int64_t last_received() const { return last_received_; }
  std::int64_t began() const { return began_; }
  /// Our CONNECTION_CLOSE, to repeat to whoever has not heard it.
  const std::vector<std::uint8_t>& close_packet() const { return close_packet_; }
  const std::vector<ngtcp2_cid>& ids() const { return ids_; }

  // The endpoint's bookkeeping.
  ConnectionId id = 0;
  std::int64_t timer = INT64_MAX;
  bool dirty = false;
  bool admitted = false;  ///< the layer above let its owner in
  std::string site;       ///< where it began, as Address::site()

 private:
  friend struct Callbacks;
  static thread_local Connection* reading;  // whose packet the library is reading
  static thread_local Connection* writing;  // or writing
  Connection(ConnectionOwner& owner, const TlsContext& tls, const EndpointOptions& options, UdpSocket& socket,
             const Address& remote, bool server, std::int64_t now);
  bool start_session(bool server);
  ngtcp2_settings settings(std::int64_t now) const;
  ngtcp2_transport_params parameters(bool server) const;
  ngtcp2_ssize write_packet(std::span<std::uint8_t> out, ngtcp2_path* path, std::int64_t now);
  ngtcp2_ssize write_datagram(std::span<std::uint8_t> out, ngtcp2_path* path, int priority, bool& accepted,
                              std::size_t packed, std::int64_t now);
  ngtcp2_ssize write_stream(std::span<std::uint8_t> out, ngtcp2_path* path, std::int64_t now);
  ngtcp2_ssize write_probe_byte(std::span<std::uint8_t> out, ngtcp2_path* path, bool more, std::int64_t now);
  std::size_t burst(const PathFigures& figures) const;
  bool bulk_allowed(std::int64_t now);
  void pace(std::size_t sent, std::size_t bulk, std::int64_t now);
  void fail(int code, std::int64_t now);
  void write_close(const CloseError& error, std::int64_t now);
  void peer_closed();
  void end(CloseReason reason);

  ConnectionOwner& owner_;
  const TlsContext& tls_;
  const EndpointOptions& options_;
  UdpSocket* socket_;
  Address remote_;
  TlsPeer peer_;
  ConnectionMemory memory_;  // outlives conn_, which the destructor deletes
  ngtcp2_conn* conn_ = nullptr;
  gnutls_session_t session_ = nullptr;
  State state_ = State::kHandshake;
  bool announced_ = false;
  bool was_reset_ = false;
  bool refused_for_good_ = false;
  const char* breach_ = nullptr;  // what the other side did that nothing of ours does
  bool wrong_protocol_ = false;
  CloseReason reason_;
  CloseReason parting_;  // what close() asked for
  std::int64_t linger_until_ = INT64_MAX;
  const std::int64_t began_;
  std::int64_t last_received_;
  DatagramQueues queues_;
  StreamOutbox streams_;
  std::size_t snapshots_in_a_row_ = 0;
  PaceGain pace_;
  DeliveredRate delivered_rate_;
  double rate_ = 0.0;  // by it, bytes a s
  SnapshotRoom snapshot_room_;
  PoseRoom pose_room_;
  LossLedger ledger_;
  std::int64_t packet_number_ = 0;   // of the last packet with a short header
  bool short_packet_ = false;        // one was written
  unsigned packed_datagrams_ = 0;    // in it
  bool held_back_ = false;           // the link shows a queue
  bool bulk_packet_ = false;         // the last packet had a snapshot's piece or a stream's bytes in it
  bool bulk_waits_ = false;          // for bulk_due_, and nothing else
  std::int64_t bulk_due_ = 0;        // when such a packet may leave again
  std::int64_t datagrams_left_ = 0;  // when the last packet of datagrams did
  std::int64_t idle_until_ = 0;      // up to then nothing was under way
  std::size_t room_ = 0;             // bytes of snapshots that this flush may still send
  bool probe_stream_due_ = false;    // a client's: the host knows it by its first byte
  std::uint64_t bytes_sent_ = 0;
  std::uint64_t bytes_received_ = 0;
  std::uint64_t packets_received_ = 0;
  std::uint64_t probe_bytes_ = 0;  // received
  ConnectionStats counts_;         // what is counted here and not in the library
  std::vector<std::uint8_t> close_packet_;
  std::vector<ngtcp2_cid> ids_;
};

}  // namespace slosh::quic
