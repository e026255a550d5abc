#include "net/quic/callbacks.h"

#include <algorithm>

#include "net/quic/connection.h"
#include "net/quic/frame_guard.h"
#include "net/random.h"
#include "net/wire/messages.h"

namespace slosh::quic {

struct Callbacks {
  static Connection& at(void* user) { return *static_cast<Connection*>(user); }

  /// The one place where we see what came before the library does. It is not told whose packet it is: see
  /// Connection::reading.
  static int decrypt(std::uint8_t* out, const ngtcp2_crypto_aead* aead, const ngtcp2_crypto_aead_ctx* context,
                     const std::uint8_t* cipher, std::size_t size, const std::uint8_t* nonce,
                     std::size_t nonce_size, const std::uint8_t* header, std::size_t header_size) {
    const int code =
        ngtcp2_crypto_decrypt_cb(out, aead, context, cipher, size, nonce, nonce_size, header, header_size);
    const bool handshake =
        header_size == 0 || (header[0] & 0x80) != 0;  // long header: few frames are allowed
    if (code != 0 || handshake || size < aead->max_overhead) return code;
    LossLedger* const ledger = Connection::reading ? &Connection::reading->ledger_ : nullptr;
    const FrameVerdict verdict = guard_frames({out, size - aead->max_overhead}, ledger);
    if (verdict == FrameVerdict::kPass) return 0;
    if (Connection::reading)
      Connection::reading->breach_ = verdict == FrameVerdict::kMalformed
                                         ? "the other side sent what is no frame of QUIC"
                                         : "the other side takes its connection ids back";
    return NGTCP2_ERR_CALLBACK_FAILURE;
  }
  static bool listening(const Connection& c) { return c.state_ == Connection::State::kOpen; }

  /// Tells the connection that writes the number of its packet: the header's last bytes are the number's.
  static int encrypt(std::uint8_t* out, const ngtcp2_crypto_aead* aead, const ngtcp2_crypto_aead_ctx* context,
                     const std::uint8_t* plain, std::size_t size, const std::uint8_t* nonce,
                     std::size_t nonce_size, const std::uint8_t* header, std::size_t header_size) {
    const std::size_t bytes = header_size > 0 ? (header[0] & 3u) + 1u : 0u;
    if (Connection::writing && header_size > bytes && (header[0] & 0x80) == 0) {
      std::int64_t low = 0;
      for (std::size_t i = header_size - bytes; i < header_size; ++i) low = low << 8 | header[i];
      const std::int64_t span = std::int64_t{1} << (8 * bytes);
      std::int64_t& number = Connection::writing->packet_number_;
      number += ((low - number) % span + span) % span;  // the next one that ends so
      Connection::writing->short_packet_ = true;
    }
    return ngtcp2_crypto_encrypt_cb(out, aead, context, plain, size, nonce, nonce_size, header, header_size);
  }

  /// Server: the client's certificate is in. Client: not yet certain that the server took ours.
  static int completed(ngtcp2_conn* conn, void* user) {
    Connection& c = at(user);
    if (!c.tls_.protocol_agreed(c.session_)) {
      c.wrong_protocol_ = true;
      return NGTCP2_ERR_CALLBACK_FAILURE;
    }
    return ngtcp2_conn_is_server(conn) ? confirmed(conn, user) : 0;
  }

  static int confirmed(ngtcp2_conn* conn, void* user) {
    Connection& c = at(user);
    if (c.state_ != Connection::State::kHandshake) return 0;
    const ngtcp2_transport_params* other = ngtcp2_conn_get_remote_transport_params(conn);
    if (!c.peer_.found || !other || other->max_datagram_frame_size < wire::kMaxDatagram + 3)
      return NGTCP2_ERR_CALLBACK_FAILURE;
    ngtcp2_conn_set_keep_alive_timeout(conn, static_cast<ngtcp2_duration>(c.options_.keep_alive * 1e9));
    std::int64_t probes = kProbeStream;
    if (!ngtcp2_conn_is_server(conn) &&
        (ngtcp2_conn_open_bidi_stream(conn, &probes, nullptr) != 0 || probes != kProbeStream))
      return NGTCP2_ERR_CALLBACK_FAILURE;
    c.probe_stream_due_ = !ngtcp2_conn_is_server(conn);
    c.state_ = Connection::State::kOpen;
    c.announced_ = true;
    c.owner_.confirmed(c);
    return 0;
  }

  static int stream_data(ngtcp2_conn* conn, std::uint32_t flags, std::int64_t stream, std::uint64_t,
                         const std::uint8_t* data, std::size_t size, void* user, void*) {
    Connection& c = at(user);
    if (stream == kProbeStream) {
      // One byte a packet, and those of lost packets again: who sends more wants to keep us busy.
      c.probe_bytes_ += size;
      if (c.probe_bytes_ > 4 * c.packets_received_ + 4096) {
        c.breach_ = "the other side sends more probes than packets";
        return NGTCP2_ERR_CALLBACK_FAILURE;
      }
    } else if (listening(c)) {
      c.owner_.stream_arrived(c, stream, {data, size}, flags & NGTCP2_STREAM_DATA_FLAG_FIN);
    }
    // Taken in: the other side may send as much again.
    ngtcp2_conn_extend_max_stream_offset(conn, stream, size);
    ngtcp2_conn_extend_max_offset(conn, size);
    // ngtcp2 0.12 never calls a one-way stream from the other side closed: its end makes room for the next.
    if ((flags & NGTCP2_STREAM_DATA_FLAG_FIN) && !ngtcp2_is_bidi_stream(stream))
      ngtcp2_conn_extend_max_streams_uni(conn, 1);
    return 0;
  }

  static int stream_acknowledged(ngtcp2_conn*, std::int64_t stream, std::uint64_t, std::uint64_t size,
                                 void* user, void*) {
    if (stream != kProbeStream) at(user).streams_.acknowledged(stream, size);
    return 0;
  }

  static int stream_closed(ngtcp2_conn* conn, std::uint32_t, std::int64_t stream, std::uint64_t, void* user,
                           void*) {
    at(user).streams_.drop(stream);
    if (!ngtcp2_conn_is_local_stream(conn, stream) && ngtcp2_is_bidi_stream(stream))
      ngtcp2_conn_extend_max_streams_bidi(conn, 1);
    return 0;
  }

  /// Nothing of ours breaks a stream off: whoever does is not to be trusted with the rest.
  static int stream_reset(ngtcp2_conn*, std::int64_t, std::uint64_t, std::uint64_t, void* user, void*) {
    at(user).breach_ = "the other side broke a stream off";
    return NGTCP2_ERR_CALLBACK_FAILURE;
  }

  static int datagram(ngtcp2_conn*, std::uint32_t, const std::uint8_t* data, std::size_t size, void* user) {
    Connection& c = at(user);
    if (listening(c)) c.owner_.datagram_arrived(c, {data, size});
    return 0;
  }

  static int datagram_lost(ngtcp2_conn*, std::uint64_t, void* user) {
    ++at(user).counts_.datagrams_lost;
    return 0;
  }

  static int stateless_reset(ngtcp2_conn*, const ngtcp2_pkt_stateless_reset*, void* user) {
    at(user).was_reset_ = true;
    return 0;
  }

  static SLOSH_PATH_VALIDATION(path_validated) {
    Connection& c = at(user);
    const Address remote(path->remote.addr, path->remote.addrlen);
    if (result != NGTCP2_PATH_VALIDATION_RESULT_SUCCESS || remote == c.remote_) return 0;
    c.remote_ = remote;
    ++c.counts_.migrations;
    if (listening(c)) c.owner_.path_changed(c, remote);
    return 0;
  }

  static int new_id(ngtcp2_conn*, ngtcp2_cid* id, std::uint8_t* token, std::size_t size, void* user) {
    Connection& c = at(user);
    fill_random({id->data, size});
    id->datalen = size;
    if (!c.owner_.reset_token(*id, token)) return NGTCP2_ERR_CALLBACK_FAILURE;
    c.ids_.push_back(*id);
    c.owner_.id_issued(c, *id);
    return 0;
  }

  static int id_gone(ngtcp2_conn*, const ngtcp2_cid* id, void* user) {
    Connection& c = at(user);
    std::erase_if(c.ids_, [&](const ngtcp2_cid& mine) { return ngtcp2_cid_eq(&mine, id); });
    c.owner_.id_retired(c, *id);
    return 0;
  }

  static void random(std::uint8_t* out, std::size_t size, const ngtcp2_rand_ctx*) {
    fill_random({out, size});
  }
};

ngtcp2_callbacks connection_callbacks() {
  ngtcp2_callbacks all{};
  all.client_initial = ngtcp2_crypto_client_initial_cb;
  all.recv_client_initial = ngtcp2_crypto_recv_client_initial_cb;
  all.recv_crypto_data = ngtcp2_crypto_recv_crypto_data_cb;
  all.encrypt = Callbacks::encrypt;
  all.decrypt = Callbacks::decrypt;
  all.hp_mask = ngtcp2_crypto_hp_mask_cb;
  all.recv_retry = ngtcp2_crypto_recv_retry_cb;
  all.update_key = ngtcp2_crypto_update_key_cb;
  all.delete_crypto_aead_ctx = ngtcp2_crypto_delete_crypto_aead_ctx_cb;
  all.delete_crypto_cipher_ctx = ngtcp2_crypto_delete_crypto_cipher_ctx_cb;
  all.get_path_challenge_data = ngtcp2_crypto_get_path_challenge_data_cb;
  all.version_negotiation = ngtcp2_crypto_version_negotiation_cb;
  all.handshake_completed = Callbacks::completed;
  all.handshake_confirmed = Callbacks::confirmed;
  all.recv_stream_data = Callbacks::stream_data;
  all.acked_stream_data_offset = Callbacks::stream_acknowledged;
  all.stream_close = Callbacks::stream_closed;
  all.stream_reset = Callbacks::stream_reset;
  all.recv_datagram = Callbacks::datagram;
  all.lost_datagram = Callbacks::datagram_lost;
  all.recv_stateless_reset = Callbacks::stateless_reset;
  all.path_validation = Callbacks::path_validated;
  all.get_new_connection_id = Callbacks::new_id;
  all.remove_connection_id = Callbacks::id_gone;
  all.rand = Callbacks::random;
  return all;
}

}  // namespace slosh::quic
