// An end of a QUIC connection that keeps no rules: it says on the wire whatever a test wants, correctly
// encrypted. A client of a host of ours, or a host of a client of ours; ngtcp2 without any of net/quic's
// guards.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "net/quic/address.h"
#include "net/quic/compat.h"
#include "net/quic/endpoint.h"
#include "net/quic/tls.h"

namespace slosh::testing {

class CraftedEnd {
 public:
  using Bytes = std::vector<std::uint8_t>;
  /// May rewrite the plaintext of a packet, whose length stays. `first` is its first byte on the wire, before
  /// header protection: ≥ 0x80 during the handshake.
  using Rewrite = std::function<void(std::uint8_t first, std::span<std::uint8_t> payload)>;

  /// A client that begins at once. `from` may be any address of loopback: 127.1.2.3 is a site of its own.
  /// Null when there is no socket.
  static std::unique_ptr<CraftedEnd> client(const std::string& to, const std::string& from = "127.0.0.1:0",
                                            Rewrite rewrite = {});
  /// A host for one client, which shows `identity`.
  static std::unique_ptr<CraftedEnd> host(const Identity& identity, Rewrite rewrite = {});
  ~CraftedEnd();

  /// Reads what came, runs timers, writes what is due. Never waits.
  void turn();
  /// Reads only: nothing is answered any more, not even acknowledged.
  void go_silent() { silent_ = true; }

  bool open() const { return open_; }  ///< the handshake is confirmed
  bool over() const { return over_; }  ///< closed by the other side, or failed
  const quic::CloseFrame& last_words() const { return last_words_; }
  std::string address() const;  ///< of the socket in use
  std::size_t datagrams() const { return datagrams_; }
  std::size_t largest_received() const { return largest_received_; }  ///< bytes of UDP payload
  std::size_t peer_ids() const { return peer_ids_; }                  ///< NEW_CONNECTION_ID frames that came

  std::size_t sockets() const { return sockets_.size(); }
  bool is_host() const { return server_; }

  /// One packet with these frames and padding. False when the window or the state forbids it.
  bool send_frames(const Bytes& frames);
  bool send_datagram(const Bytes& bytes);

  /// From now on packets leave from another port, as behind a router that forgot. The first socket is 0.
  std::size_t add_socket(const std::string& from = "127.0.0.1:0");
  void use_socket(std::size_t index);
  /// The same, with a connection id of the host's that was not used before.
  bool migrate_to(std::size_t index);

 private:
  friend struct CraftedCallbacks;
  struct Socket {
    int descriptor = -1;
    quic::Address local;
  };
  CraftedEnd(const Identity& identity, Rewrite rewrite);
  void receive();
  void write();
  void fail(int code);
  void emit(std::span<const std::uint8_t> packet);
  bool begin_host(std::span<const std::uint8_t> packet, const quic::Address& from);

  Identity identity_;
  quic::TlsContext tls_;
  quic::TlsPeer peer_;
  Rewrite rewrite_;
  bool server_ = false;
  ngtcp2_conn* conn_ = nullptr;
  gnutls_session_t session_ = nullptr;
  std::vector<Socket> sockets_;
  std::size_t socket_ = 0;
  quic::Address remote_;
  bool open_ = false;
  bool over_ = false;
  bool silent_ = false;
  quic::CloseFrame last_words_;
  std::size_t datagrams_ = 0;
  std::size_t largest_received_ = 0;
  std::size_t peer_ids_ = 0;
  Bytes next_frames_;  // in place of what the library would say in the next packet
};

/// A variable-length integer of QUIC, in as few bytes as it needs.
void put_integer(CraftedEnd::Bytes& out, std::uint64_t value);
/// A NEW_CONNECTION_ID frame; its id and token are made from `sequence`.
CraftedEnd::Bytes new_connection_id(std::uint64_t sequence, std::uint64_t retire_prior_to,
                                    std::uint8_t salt = 0);

}  // namespace slosh::testing
