#include "tests/net/quic/crafted_end.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "net/clock.h"
#include "net/random.h"

namespace slosh::testing {
namespace {

using quic::Address;
using Bytes = CraftedEnd::Bytes;

constexpr std::size_t kIdSize = 10;
thread_local CraftedEnd* writing = nullptr;  // whose packet encrypt() is asked to encrypt

/// Encrypts for `end` from here to the end of the block.
class Writing {
 public:
  explicit Writing(CraftedEnd* end) : before_(std::exchange(writing, end)) {}
  ~Writing() { writing = before_; }

 private:
  CraftedEnd* before_;
};

ngtcp2_cid random_id(std::size_t size) {
  ngtcp2_cid id{};
  id.datalen = size;
  fill_random({id.data, size});
  return id;
}

ngtcp2_tstamp now() {
  return static_cast<ngtcp2_tstamp>(steady_now_ns());
}

ngtcp2_path path_between(Address& local, Address& remote) {
  return {{&local.any, local.length}, {&remote.any, remote.length}, nullptr};
}

}  // namespace

struct CraftedCallbacks {
  static CraftedEnd& at(void* user) { return *static_cast<CraftedEnd*>(user); }

  static int encrypt(std::uint8_t* out, const ngtcp2_crypto_aead* aead, const ngtcp2_crypto_aead_ctx* context,
                     const std::uint8_t* plain, std::size_t size, const std::uint8_t* nonce,
                     std::size_t nonce_size, const std::uint8_t* header, std::size_t header_size) {
    Bytes payload(plain, plain + size);
    if (writing) {
      const bool handshake = header_size > 0 && (header[0] & 0x80) != 0;
      if (!handshake && !writing->next_frames_.empty()) {
        const Bytes frames = std::exchange(writing->next_frames_, {});
        std::fill(payload.begin(), payload.end(), std::uint8_t{0});
        std::copy_n(frames.begin(), std::min(frames.size(), payload.size()), payload.begin());
      } else if (writing->rewrite_) {
        writing->rewrite_(header_size > 0 ? header[0] : 0, payload);
      }
    }
    return ngtcp2_crypto_encrypt_cb(out, aead, context, payload.data(), payload.size(), nonce, nonce_size,
                                    header, header_size);
  }
  static int decrypt(std::uint8_t* out, const ngtcp2_crypto_aead* aead, const ngtcp2_crypto_aead_ctx* context,
                     const std::uint8_t* cipher, std::size_t size, const std::uint8_t* nonce,
                     std::size_t nonce_size, const std::uint8_t* header, std::size_t header_size) {
    const int code =
        ngtcp2_crypto_decrypt_cb(out, aead, context, cipher, size, nonce, nonce_size, header, header_size);
    // Good enough to count what our ends send first in a packet.
    if (code == 0 && writing && header_size > 0 && !(header[0] & 0x80)) {
      const std::span<const std::uint8_t> payload(out, size - aead->max_overhead);
      writing->peer_ids_ += !payload.empty() && payload[0] == 0x18 ? 1 : 0;
    }
    return code;
  }
  static int completed(ngtcp2_conn* conn, void* user) {
    if (ngtcp2_conn_is_server(conn)) at(user).open_ = true;
    return 0;
  }
  static int confirmed(ngtcp2_conn*, void* user) {
    at(user).open_ = true;
    return 0;
  }
  static int stream_data(ngtcp2_conn* conn, std::uint32_t, std::int64_t stream, std::uint64_t,
                         const std::uint8_t*, std::size_t size, void*, void*) {
    ngtcp2_conn_extend_max_stream_offset(conn, stream, size);
    ngtcp2_conn_extend_max_offset(conn, size);
    return 0;
  }
  static int datagram(ngtcp2_conn*, std::uint32_t, const std::uint8_t*, std::size_t, void* user) {
    ++at(user).datagrams_;
    return 0;
  }
  static int new_id(ngtcp2_conn*, ngtcp2_cid* id, std::uint8_t* token, std::size_t size, void*) {
    *id = random_id(size);
    fill_random({token, NGTCP2_STATELESS_RESET_TOKENLEN});
    return 0;
  }
  static void random(std::uint8_t* out, std::size_t size, const ngtcp2_rand_ctx*) {
    fill_random({out, size});
  }

  static ngtcp2_callbacks all() {
    ngtcp2_callbacks all{};
    all.client_initial = ngtcp2_crypto_client_initial_cb;
    all.recv_client_initial = ngtcp2_crypto_recv_client_initial_cb;
    all.recv_crypto_data = ngtcp2_crypto_recv_crypto_data_cb;
    all.encrypt = encrypt;
    all.decrypt = decrypt;
    all.hp_mask = ngtcp2_crypto_hp_mask_cb;
    all.recv_retry = ngtcp2_crypto_recv_retry_cb;
    all.update_key = ngtcp2_crypto_update_key_cb;
    all.delete_crypto_aead_ctx = ngtcp2_crypto_delete_crypto_aead_ctx_cb;
    all.delete_crypto_cipher_ctx = ngtcp2_crypto_delete_crypto_cipher_ctx_cb;
    all.get_path_challenge_data = ngtcp2_crypto_get_path_challenge_data_cb;
    all.version_negotiation = ngtcp2_crypto_version_negotiation_cb;
    all.handshake_completed = completed;
    all.handshake_confirmed = confirmed;
    all.recv_stream_data = stream_data;
    all.recv_datagram = datagram;
    all.get_new_connection_id = new_id;
    all.rand = random;
    return all;
  }
  static ngtcp2_settings settings() {
    ngtcp2_settings settings;
    ngtcp2_settings_default(&settings);
    settings.initial_ts = now();
    settings.max_tx_udp_payload_size = 1200;
    settings.handshake_timeout = 10 * NGTCP2_SECONDS;
    return settings;
  }
  static ngtcp2_transport_params params() {
    ngtcp2_transport_params params;
    ngtcp2_transport_params_default(&params);
    params.initial_max_stream_data_bidi_local = 1 << 20;
    params.initial_max_stream_data_bidi_remote = 1 << 20;
    params.initial_max_stream_data_uni = 1 << 20;
    params.initial_max_data = 1 << 22;
    params.initial_max_streams_bidi = 10;
    params.initial_max_streams_uni = 10;
    params.max_idle_timeout = 30 * NGTCP2_SECONDS;
    params.active_connection_id_limit = 7;
    params.max_datagram_frame_size = 1500;
    return params;
  }
};

CraftedEnd::CraftedEnd(const Identity& identity, Rewrite rewrite)
    : identity_(identity), tls_(identity_), rewrite_(std::move(rewrite)) {
  peer_.reference.user_data = this;
  peer_.reference.get_conn = [](ngtcp2_crypto_conn_ref* reference) {
    return static_cast<CraftedEnd*>(reference->user_data)->conn_;
  };
}

CraftedEnd::~CraftedEnd() {
  if (conn_) ngtcp2_conn_del(conn_);
  if (session_) gnutls_deinit(session_);
  for (const Socket& socket : sockets_) close(socket.descriptor);
}

std::unique_ptr<CraftedEnd> CraftedEnd::client(const std::string& to, const std::string& from,
                                               Rewrite rewrite) {
  static const Identity stranger = Identity::generate();  // one will do for hundreds
  std::unique_ptr<CraftedEnd> end(new CraftedEnd(stranger, std::move(rewrite)));
  end->remote_ = quic::numeric_address(to);
  end->remote_.set_port(static_cast<std::uint16_t>(std::stoi(to.substr(to.rfind(':') + 1))));
  if (end->add_socket(from) != 0) return nullptr;
  const ngtcp2_settings settings = CraftedCallbacks::settings();
  const ngtcp2_transport_params params = CraftedCallbacks::params();
  const ngtcp2_callbacks callbacks = CraftedCallbacks::all();
  const ngtcp2_cid host_id = random_id(18), own_id = random_id(kIdSize);
  const ngtcp2_path path = path_between(end->sockets_[0].local, end->remote_);
  if (ngtcp2_conn_client_new(&end->conn_, &host_id, &own_id, &path, NGTCP2_PROTO_VER_V1, &callbacks,
                             &settings, &params, nullptr, end.get()) != 0)
    return nullptr;
  end->session_ = end->tls_.open(false, end->peer_);
  ngtcp2_conn_set_tls_native_handle(end->conn_, end->session_);
  end->write();
  return end;
}

std::unique_ptr<CraftedEnd> CraftedEnd::host(const Identity& identity, Rewrite rewrite) {
  std::unique_ptr<CraftedEnd> end(new CraftedEnd(identity, std::move(rewrite)));
  end->server_ = true;
  return end->add_socket("127.0.0.1:0") == 0 ? std::move(end) : nullptr;
}

bool CraftedEnd::begin_host(std::span<const std::uint8_t> packet, const Address& from) {
  ngtcp2_pkt_hd header{};
  if (ngtcp2_accept(&header, packet.data(), packet.size()) != 0) return false;
  remote_ = from;
  const ngtcp2_settings settings = CraftedCallbacks::settings();
  ngtcp2_transport_params params = CraftedCallbacks::params();
  quic::set_original_dcid(params, header.dcid);
  const ngtcp2_callbacks callbacks = CraftedCallbacks::all();
  const ngtcp2_cid own_id = random_id(kIdSize);
  const ngtcp2_path path = path_between(sockets_[0].local, remote_);
  if (ngtcp2_conn_server_new(&conn_, &header.scid, &own_id, &path, header.version, &callbacks, &settings,
                             &params, nullptr, this) != 0)
    return false;
  session_ = tls_.open(true, peer_);
  ngtcp2_conn_set_tls_native_handle(conn_, session_);
  return true;
}

std::size_t CraftedEnd::add_socket(const std::string& from) {
  Address local = quic::numeric_address(from);
  local.set_port(static_cast<std::uint16_t>(std::stoi(from.substr(from.rfind(':') + 1))));
  const int descriptor = ::socket(local.any.sa_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0 || bind(descriptor, &local.any, local.length) != 0) return SIZE_MAX;
  local.length = sizeof(local.v6);
  getsockname(descriptor, &local.any, &local.length);
  sockets_.push_back({descriptor, local});
  return sockets_.size() - 1;
}

void CraftedEnd::use_socket(std::size_t index) {
  socket_ = index;
  const ngtcp2_addr local{&sockets_[index].local.any, sockets_[index].local.length};
  ngtcp2_conn_set_local_addr(conn_, &local);
}

bool CraftedEnd::migrate_to(std::size_t index) {
  socket_ = index;
  const ngtcp2_path path = path_between(sockets_[index].local, remote_);
  const Writing mine(this);
  return ngtcp2_conn_initiate_immediate_migration(conn_, &path, now()) == 0;
}

std::string CraftedEnd::address() const {
  return sockets_[socket_].local.text();
}

void CraftedEnd::turn() {
  receive();
  if (!conn_ || over_ || silent_) return;
  if (ngtcp2_conn_get_expiry(conn_) <= now()) {
    const Writing mine(this);
    if (const int code = ngtcp2_conn_handle_expiry(conn_, now()); code != 0) return fail(code);
  }
  write();
}

void CraftedEnd::receive() {
  std::uint8_t buffer[2048];
  for (std::size_t i = 0; i < sockets_.size(); ++i) {
    for (;;) {
      Address from;
      from.length = sizeof(from.v6);
      const ssize_t size =
          recvfrom(sockets_[i].descriptor, buffer, sizeof(buffer), 0, &from.any, &from.length);
      if (size < 0) break;
      largest_received_ = std::max(largest_received_, static_cast<std::size_t>(size));
      if (over_ || silent_) continue;
      const std::span<const std::uint8_t> packet(buffer, static_cast<std::size_t>(size));
      if (!conn_ && (!server_ || !begin_host(packet, from))) continue;
      remote_ = server_ ? from : remote_;
      const ngtcp2_path path = path_between(sockets_[i].local, remote_);
      ngtcp2_pkt_info info{};
      const Writing mine(this);
      const int code = ngtcp2_conn_read_pkt(conn_, &path, &info, packet.data(), packet.size(), now());
      if (code != 0) fail(code);
    }
  }
}

void CraftedEnd::fail(int code) {
  over_ = true;
  if (code == NGTCP2_ERR_DRAINING) last_words_ = quic::received_close(conn_);
}

void CraftedEnd::write() {
  std::uint8_t packet[1200];
  const Writing mine(this);
  for (int count = 0; count < 50; ++count) {
    const ngtcp2_ssize size = ngtcp2_conn_write_pkt(conn_, nullptr, nullptr, packet, sizeof(packet), now());
    if (size < 0) return fail(static_cast<int>(size));
    if (size == 0) break;
    emit({packet, static_cast<std::size_t>(size)});
  }
  ngtcp2_conn_update_pkt_tx_time(conn_, now());
}

void CraftedEnd::emit(std::span<const std::uint8_t> packet) {
  sendto(sockets_[socket_].descriptor, packet.data(), packet.size(), 0, &remote_.any, remote_.length);
}

bool CraftedEnd::send_frames(const Bytes& frames) {
  next_frames_ = frames;
  // The library's datagram makes the room that the frames get.
  const bool sent = send_datagram(Bytes(std::max<std::size_t>(frames.size(), 24), 0));
  next_frames_.clear();
  return sent;
}

bool CraftedEnd::send_datagram(const Bytes& bytes) {
  if (!conn_ || over_ || silent_) return false;
  std::uint8_t packet[1200];
  const ngtcp2_vec vector{const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
  int taken = 0;
  const Writing mine(this);
  while (taken == 0) {
    const ngtcp2_ssize size =
        ngtcp2_conn_writev_datagram(conn_, nullptr, nullptr, packet, sizeof(packet), &taken,
                                    NGTCP2_WRITE_DATAGRAM_FLAG_NONE, 0, &vector, 1, now());
    if (size <= 0) return false;
    emit({packet, static_cast<std::size_t>(size)});
  }
  ngtcp2_conn_update_pkt_tx_time(conn_, now());
  return true;
}

void put_integer(Bytes& out, std::uint64_t value) {
  int shift = value < 64 ? 0 : value < 16384 ? 1 : value < 1u << 30 ? 2 : 3;
  const int bytes = 1 << shift;
  for (int i = bytes - 1; i >= 0; --i) {
    auto byte = static_cast<std::uint8_t>(value >> (8 * i));
    if (i == bytes - 1) byte |= static_cast<std::uint8_t>(shift << 6);
    out.push_back(byte);
  }
}

Bytes new_connection_id(std::uint64_t sequence, std::uint64_t retire_prior_to, std::uint8_t salt) {
  Bytes out{0x18};
  put_integer(out, sequence);
  put_integer(out, retire_prior_to);
  out.push_back(8);
  for (int i = 0; i < 8; ++i) out.push_back(static_cast<std::uint8_t>((sequence >> (8 * i)) + salt));
  for (int i = 0; i < 16; ++i)
    out.push_back(static_cast<std::uint8_t>(sequence * 7 + static_cast<unsigned>(i)));
  return out;
}

}  // namespace slosh::testing
