#include "net/quic/connection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "net/quic/callbacks.h"
#include "net/quic/close_words.h"
#include "net/random.h"
#include "net/wire/messages.h"

namespace slosh::quic {
namespace {

ngtcp2_duration nanoseconds(double seconds) {
  return static_cast<ngtcp2_duration>(seconds * 1e9);
}

ngtcp2_cid random_id(std::size_t size) {
  ngtcp2_cid id{};
  id.datalen = size;
  fill_random({id.data, size});
  return id;
}

ngtcp2_path path_between(Address& local, Address& remote) {
  return {{&local.any, local.length}, {&remote.any, remote.length}, nullptr};
}

constexpr std::size_t kLongestDatagramFrame = wire::kMaxDatagram + 16;
constexpr std::size_t kWindowPacket = 64 << 10;      // bytes; a quarter of the narrowest window
constexpr std::uint64_t kControlWindow = 256 << 10;  // bytes a client may have on its way to a host
constexpr std::uint64_t kSceneWindow = 8u << 20;     // bytes a host may have on its way to a peer
constexpr std::uint64_t kWidestWindow = 24u << 20;   // what a fast, far link may let it grow to

}  // namespace

thread_local Connection* Connection::reading = nullptr;
thread_local Connection* Connection::writing = nullptr;

Connection::Connection(ConnectionOwner& owner, const TlsContext& tls, const EndpointOptions& options,
                       UdpSocket& socket, const Address& remote, bool server, std::int64_t now)
    : owner_(owner),
      tls_(tls),
      options_(options),
      socket_(&socket),
      remote_(remote),
      began_(now),
      last_received_(now),
      queues_(options.queue_datagrams),
      pose_room_(server ? PoseRoom::kOfHost : PoseRoom::kOfPeer) {
  peer_.reference.user_data = this;
  peer_.reference.get_conn = [](ngtcp2_crypto_conn_ref* reference) {
    return static_cast<Connection*>(reference->user_data)->conn_;
  };
}

Connection::~Connection() {
  if (conn_) ngtcp2_conn_del(conn_);
  if (session_) gnutls_deinit(session_);
}

ngtcp2_settings Connection::settings(std::int64_t now) const {
  ngtcp2_settings settings;
  ngtcp2_settings_default(&settings);
  settings.cc_algo = kCongestionControl;
  settings.initial_ts = static_cast<ngtcp2_tstamp>(now);
  settings.initial_rtt = 100 * NGTCP2_MILLISECONDS;
  settings.handshake_timeout = nanoseconds(options_.handshake_timeout);
  // ngtcp2 counts windows in such packets: its least is four of them. It is to hold whatever poses and states
  // are under way (pose_room.h); no packet gets longer, since there is never room for more than kMaxPacket,
  // and the library looks for no longer MTU, since neither side allows one (tls.cpp sees to that).
  settings.max_tx_udp_payload_size = kWindowPacket;
  // Nothing is probed, since no packet may be longer. Switched off (no_pmtud), ngtcp2 to 1.11 asserts when a
  // peer's packets come from a new port and then from the old one again.
  settings.no_pmtud = 0;
  // A snapshot comes in tens of packets: an acknowledgement for every second would cost the host more
  // than it tells. Losses are still reported at once.
  settings.ack_thresh = 10;
  return settings;
}

ngtcp2_transport_params Connection::parameters(bool server) const {
  ngtcp2_transport_params params;
  ngtcp2_transport_params_default(&params);
  const std::uint64_t window = server ? kControlWindow : kSceneWindow;
  params.initial_max_stream_data_bidi_local = server ? kControlWindow : 2 * kControlWindow;
  params.initial_max_stream_data_bidi_remote = kControlWindow;
  params.initial_max_stream_data_uni = window;
  params.initial_max_data = server ? kControlWindow : 2 * kSceneWindow;
  params.initial_max_streams_bidi = 5;  // the probes' and four more
  // A host takes no one-way streams: ngtcp2 0.12 keeps a little of each until the connection ends.
  params.initial_max_streams_uni = server ? 0 : 16;
  params.max_idle_timeout = nanoseconds(options_.idle_timeout);
  params.max_udp_payload_size = kMaxPacket;
  params.active_connection_id_limit = 2;  // the least there is: none but the first is used (frame_guard.h)
  params.max_ack_delay = 5 * NGTCP2_MILLISECONDS;
  params.max_datagram_frame_size = kLongestDatagramFrame;
  return params;
}

bool Connection::start_session(bool server) {
  session_ = tls_.open(server, peer_);
  if (!session_) return false;
  ngtcp2_conn_set_tls_native_handle(conn_, session_);
  return true;
}

std::unique_ptr<Connection> Connection::to_host(ConnectionOwner& owner, const TlsContext& tls,
                                                const EndpointOptions& options, UdpSocket& socket,
                                                const Address& remote, const KeyFingerprint& host,
                                                std::int64_t now) {
  std::unique_ptr<Connection> made(new Connection(owner, tls, options, socket, remote, false, now));
  made->peer_.expected = host;
  ngtcp2_settings settings = made->settings(now);
  settings.max_window = 2 * kWidestWindow;
  settings.max_stream_window = kWidestWindow;
  const ngtcp2_transport_params params = made->parameters(false);
  const ngtcp2_callbacks callbacks = connection_callbacks();
  const ngtcp2_cid host_id = random_id(18);
  const ngtcp2_cid own_id = random_id(kCidSize);
  Address local = socket.local();
  const ngtcp2_path path = path_between(local, made->remote_);
  if (ngtcp2_conn_client_new(&made->conn_, &host_id, &own_id, &path, NGTCP2_PROTO_VER_V1, &callbacks,
                             &settings, &params, made->memory_.functions(), made.get()) != 0 ||
      !made->start_session(false))
    return nullptr;
  made->ids_.push_back(own_id);
  return made;
}

std::unique_ptr<Connection> Connection::from_client(ConnectionOwner& owner, const TlsContext& tls,
                                                    const EndpointOptions& options, UdpSocket& socket,
                                                    const Address& local, const Address& remote,
                                                    const FirstPacket& first, std::int64_t now) {
  std::unique_ptr<Connection> made(new Connection(owner, tls, options, socket, remote, true, now));
  ngtcp2_settings settings = made->settings(now);
  set_token(settings, first.token.data(), first.token.size());
  ngtcp2_transport_params params = made->parameters(true);
  const ngtcp2_cid own_id = random_id(kCidSize);
  set_original_dcid(params, first.original_id);
  params.retry_scid = first.retry_id;
  params.retry_scid_present = 1;
  params.stateless_reset_token_present = owner.reset_token(own_id, params.stateless_reset_token) ? 1 : 0;
  const ngtcp2_callbacks callbacks = connection_callbacks();
  Address from = local;
  const ngtcp2_path path = path_between(from, made->remote_);
  if (ngtcp2_conn_server_new(&made->conn_, &first.client_id, &own_id, &path, first.version, &callbacks,
                             &settings, &params, made->memory_.functions(), made.get()) != 0 ||
      !made->start_session(true))
    return nullptr;
  made->ids_ = {own_id, first.retry_id};
  return made;
}

void Connection::receive(const Address& local, const Address& remote, std::span<const std::uint8_t> packet,
                         std::int64_t now) {
  if (state_ == State::kClosed) return;
  bytes_received_ += packet.size();
  packets_received_ += 1;
  Address here = local;
  Address there = remote;
  const ngtcp2_path path = path_between(here, there);
  ngtcp2_pkt_info info{};
  Connection* const outer = std::exchange(reading, this);
  const int code = ngtcp2_conn_read_pkt(conn_, &path, &info, packet.data(), packet.size(),
                                        static_cast<ngtcp2_tstamp>(now));
  reading = outer;
  last_received_ = now;
  if (code != 0) fail(code, now);
}

void Connection::expire(std::int64_t now) {
  if (state_ == State::kClosed) return;
  if (linger_until_ <= now) {
    abort(parting_.code, parting_.text, now);
    return;
  }
  const int code = ngtcp2_conn_handle_expiry(conn_, static_cast<ngtcp2_tstamp>(now));
  if (code != 0) fail(code, now);
}

std::int64_t Connection::expiry() const {
  if (state_ == State::kClosed) return INT64_MAX;
  const ngtcp2_tstamp due = ngtcp2_conn_get_expiry(conn_);
  const std::int64_t library =
      due > static_cast<ngtcp2_tstamp>(INT64_MAX) ? INT64_MAX : static_cast<std::int64_t>(due);
  return std::min({library, linger_until_, bulk_waits_ ? bulk_due_ : INT64_MAX});
}

bool Connection::send_datagram(Priority priority, SharedBytes bytes) {
  if (state_ != State::kOpen || !bytes || bytes->empty() || bytes->size() > wire::kMaxDatagram) return false;
  const int index = static_cast<int>(priority);
  counts_.datagrams_dropped[index] += queues_.push(index, std::move(bytes));
  return true;
}

std::int64_t Connection::open_stream(bool both_ways) {
  if (state_ != State::kOpen) return -1;
  std::int64_t stream = -1;
  const int code = both_ways ? ngtcp2_conn_open_bidi_stream(conn_, &stream, nullptr)
                             : ngtcp2_conn_open_uni_stream(conn_, &stream, nullptr);
  return code == 0 ? stream : -1;
}

bool Connection::send_stream(std::int64_t stream, std::span<const std::uint8_t> bytes, bool end) {
  if (state_ != State::kOpen || stream < 0) return false;
  if (bytes.empty() && !end) return true;
  return streams_.push(stream, bytes, end, options_.stream_buffer);
}

bool Connection::send_shared(std::int64_t stream, SharedBytes bytes, bool end) {
  if (state_ != State::kOpen || stream < 0) return false;
  if (bytes->empty() && !end) return true;
  return streams_.push(stream, std::move(bytes), end, options_.stream_buffer);
}

void Connection::close(std::uint64_t code, const std::string& text, std::int64_t now) {
  if (state_ == State::kClosed || state_ == State::kLingering) return;
  parting_ = {false, code, text.substr(0, 1000)};
  linger_until_ = now;
  if (state_ == State::kOpen && !streams_.settled()) {
    const double patience = std::clamp(8.0 * path_figures(conn_).smoothed_rtt, 0.2, 1.0);
    linger_until_ = now + static_cast<std::int64_t>(patience * 1e9);
  }
  state_ = State::kLingering;
  queues_.clear();
}

void Connection::abort(std::uint64_t code, const std::string& text, std::int64_t now) {
  if (state_ == State::kClosed) return;
  CloseError error;
  const std::string words = text.substr(0, 1000);
  set_application_error(error, code, words);
  write_close(error, now);
  end({false, code, text});
}

void Connection::put_off(const std::string& text, std::int64_t now) {
  if (state_ == State::kClosed) return;
  CloseError error;
  const std::string words = text.substr(0, 1000);  // the error points there
  set_transport_error(error, NGTCP2_CONNECTION_REFUSED, words);
  write_close(error, now);
  end({false, 0, text, CloseCause::kBusy});
}

void Connection::move_to(UdpSocket& socket, std::int64_t now) {
  socket_ = &socket;
  Address local = socket.local();
  // The host sees a known connection from a new address and makes sure of it by itself.
  const ngtcp2_addr address{&local.any, local.length};
  ngtcp2_conn_set_local_addr(conn_, &address);
  // It must see something: a keep-alive that is due at once.
  ngtcp2_conn_set_keep_alive_timeout(conn_, 1);
  expire(now);
  flush(now);
  if (state_ != State::kClosed) ngtcp2_conn_set_keep_alive_timeout(conn_, nanoseconds(options_.keep_alive));
}

ConnectionStats Connection::stats() const {
  ConnectionStats stats = counts_;
  const PathFigures figures = path_figures(conn_);
  stats.smoothed_rtt = figures.smoothed_rtt;
  stats.rtt_variance = figures.rtt_variance;
  stats.min_rtt = figures.min_rtt;
  stats.window = figures.window;
  stats.in_flight = figures.in_flight;
  stats.delivery_rate = rate_;
  stats.datagrams_lost = ledger_.lost();
  stats.bytes_sent = bytes_sent_;
  stats.bytes_received = bytes_received_;
  return stats;
}

void Connection::fail(int code, std::int64_t now) {
  if (state_ == State::kClosed) return;
  if (state_ == State::kLingering && code != NGTCP2_ERR_DRAINING) {
    abort(parting_.code, parting_.text, now);
    return;
  }
  switch (code) {
    case NGTCP2_ERR_DRAINING:
      return peer_closed();
    case NGTCP2_ERR_RETRY:
    case NGTCP2_ERR_DROP_CONN:
      return end({false, 0, "the first packet was damaged", CloseCause::kBroken});
    case NGTCP2_ERR_IDLE_CLOSE:
      return end({false, 0, timed_out_words(options_.idle_timeout), CloseCause::kTimedOut});
    case NGTCP2_ERR_HANDSHAKE_TIMEOUT:
      // A host that is busy answers the first packet, and puts off the second.
      return end(
          {false, 0,
           no_answer_words(remote_, options_.handshake_timeout, socket_->send_error(), bytes_received_ > 0),
           bytes_received_ > 0 ? CloseCause::kBusy : CloseCause::kNoAnswer});
    default:
      break;
  }
  CloseError error;
  std::string text = library_words(code);
  if (code == NGTCP2_ERR_CRYPTO) {
    const std::uint8_t alert = ngtcp2_conn_get_tls_alert(conn_);
    set_tls_alert(error, alert);
    text = peer_.refusal.empty() ? alert_words(alert) : peer_.refusal;
    refused_for_good_ = true;
  } else {
    set_library_error(error, code);
  }
  if (wrong_protocol_) {
    constexpr std::uint8_t kNoApplicationProtocol = 120;
    set_tls_alert(error, kNoApplicationProtocol);
    text = alert_words(kNoApplicationProtocol);
    refused_for_good_ = true;
  }
  if (breach_) {
    text = breach_;
    set_transport_error(error, NGTCP2_PROTOCOL_VIOLATION, text);
  }
  write_close(error, now);
  end({false, 0, text, refused_for_good_ ? CloseCause::kRefused : CloseCause::kBroken});
}

void Connection::peer_closed() {
  if (state_ == State::kLingering) return end({false, parting_.code, parting_.text});
  if (was_reset_)
    return end({true, 0, "the other side has lost this connection: it started anew", CloseCause::kLost});
  const CloseFrame frame = received_close(conn_);
  const bool server = ngtcp2_conn_is_server(conn_) != 0;
  const bool busy = !frame.application && frame.code == NGTCP2_CONNECTION_REFUSED;
  const bool alert = !frame.application && frame.code >= NGTCP2_CRYPTO_ERROR;
  refused_for_good_ = !frame.application && !busy;
  CloseCause cause = CloseCause::kBroken;
  if (busy) cause = CloseCause::kBusy;
  if (alert) cause = CloseCause::kRefused;
  if (frame.application || frame.code == NGTCP2_NO_ERROR) cause = CloseCause::kClosed;
  end({true, frame.application ? frame.code : 0,
       frame.application ? printable(frame.text) : transport_words(frame, server), cause});
}

void Connection::end(CloseReason reason) {
  if (state_ == State::kClosed) return;
  state_ = State::kClosed;
  reason_ = std::move(reason);
  queues_.clear();
}

}  // namespace slosh::quic
