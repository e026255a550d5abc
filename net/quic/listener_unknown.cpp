// What a host answers to senders that it does not know: as little as possible, and nothing kept.
#include <algorithm>

#include "net/clock.h"
#include "net/quic/listener.h"
#include "net/random.h"

namespace slosh::quic {
namespace {

constexpr double kAnswersPerSecond = 2000.0;
constexpr ngtcp2_duration kTokenLife = 10 * NGTCP2_SECONDS;

}  // namespace

bool Listener::may_answer(std::int64_t now) {
  answers_left_ = std::min(kAnswersPerSecond / 2.0,
                           answers_left_ + kAnswersPerSecond * 1e-9 * static_cast<double>(now - answers_at_));
  answers_at_ = now;
  if (answers_left_ < 1.0) return false;
  answers_left_ -= 1.0;
  return true;
}

void Listener::first_packet(UdpSocket& socket, const Arrival& packet, std::int64_t now) {
  ngtcp2_pkt_hd header{};
  if (ngtcp2_accept(&header, packet.bytes.data(), packet.bytes.size()) != 0) {
    ++counts_.packets_ignored;
    return;
  }
  const std::uint8_t* token = nullptr;
  std::size_t size = 0;
  token_of(header, token, size);
  if (size == 0) return answer_retry(socket, packet, header, now);
  FirstPacket first;
  if (!token_valid(header, packet, now, first)) {
    ++counts_.packets_ignored;
    return;
  }
  if (!budget_.take(packet.from.site(), now)) {
    ++counts_.handshakes_put_off;
    return;
  }
  if (!make_room(now)) return answer_full(socket, packet, first);
  accept(socket, packet, first, now);
}

/// A token is good for one connection, from the address and in the time that it was made for.
bool Listener::token_valid(const ngtcp2_pkt_hd& header, const Arrival& packet, std::int64_t now,
                           FirstPacket& first) {
  const std::uint8_t* token = nullptr;
  std::size_t size = 0;
  token_of(header, token, size);
  if (token[0] != NGTCP2_CRYPTO_TOKEN_MAGIC_RETRY) return false;
  if (used_tokens_.contains(
          std::string(reinterpret_cast<const char*>(header.dcid.data), header.dcid.datalen)))
    return false;
  if (ngtcp2_crypto_verify_retry_token(&first.original_id, token, size, token_secret_.data(),
                                       token_secret_.size(), header.version, &packet.from.any,
                                       packet.from.length, &header.dcid, kTokenLife,
                                       static_cast<ngtcp2_tstamp>(now)) != 0)
    return false;
  first.client_id = header.scid;
  first.retry_id = header.dcid;
  first.version = header.version;
  first.token.assign(token, token + size);
  return true;
}

void Listener::answer_retry(UdpSocket& socket, const Arrival& packet, const ngtcp2_pkt_hd& header,
                            std::int64_t now) {
  if (!may_answer(now)) {
    ++counts_.packets_ignored;
    return;
  }
  ngtcp2_cid id{};
  id.datalen = kCidSize;
  fill_random({id.data, id.datalen});
  std::uint8_t token[NGTCP2_CRYPTO_MAX_RETRY_TOKENLEN];
  const ngtcp2_ssize token_size = ngtcp2_crypto_generate_retry_token(
      token, token_secret_.data(), token_secret_.size(), header.version, &packet.from.any, packet.from.length,
      &id, &header.dcid, static_cast<ngtcp2_tstamp>(now));
  const auto out = socket.space();
  if (token_size < 0 || out.empty()) return;
  const ngtcp2_ssize size =
      ngtcp2_crypto_write_retry(out.data(), out.size(), header.version, &header.scid, &id, &header.dcid,
                                token, static_cast<std::size_t>(token_size));
  if (size <= 0) return;
  socket.add(packet.to, packet.from, static_cast<std::size_t>(size));
  ++counts_.retries_sent;
}

void Listener::answer_version(UdpSocket& socket, const Arrival& packet, const ngtcp2_version_cid& ids,
                              std::int64_t now) {
  ++counts_.packets_ignored;
  const auto out = socket.space();
  if (packet.bytes.size() < kMaxPacket || out.empty() || !may_answer(now)) return;
  const std::uint32_t versions[] = {NGTCP2_PROTO_VER_V1};
  std::uint8_t noise = 0;
  fill_random({&noise, 1});
  const ngtcp2_ssize size =
      ngtcp2_pkt_write_version_negotiation(out.data(), out.size(), noise, ids.scid, ids.scidlen, ids.dcid,
                                           ids.dcidlen, versions, std::size(versions));
  if (size > 0) socket.add(packet.to, packet.from, static_cast<std::size_t>(size));
}

/// Tells a peer of an earlier life of this host that its connection is gone. Always shorter than what came,
/// so that two hosts cannot keep answering each other.
void Listener::answer_reset(UdpSocket& socket, const Arrival& packet, const ngtcp2_version_cid& ids,
                            std::int64_t now) {
  ++counts_.packets_ignored;
  constexpr std::size_t kSmallest = NGTCP2_STATELESS_RESET_TOKENLEN + NGTCP2_MIN_STATELESS_RESET_RANDLEN;
  const auto out = socket.space();
  if (ids.dcidlen != kCidSize || packet.bytes.size() <= kSmallest + 1 || out.empty() || !may_answer(now))
    return;
  ngtcp2_cid id{};
  ngtcp2_cid_init(&id, ids.dcid, ids.dcidlen);
  std::uint8_t token[NGTCP2_STATELESS_RESET_TOKENLEN];
  if (!reset_token(id, token)) return;
  std::uint8_t noise[64];
  fill_random(noise);
  const std::size_t size = std::min<std::size_t>(packet.bytes.size() - 1, 43);
  const ngtcp2_ssize written = ngtcp2_pkt_write_stateless_reset(out.data(), size, token, noise,
                                                                size - NGTCP2_STATELESS_RESET_TOKENLEN);
  if (written > 0) socket.add(packet.to, packet.from, static_cast<std::size_t>(written));
}

void Listener::answer_full(UdpSocket& socket, const Arrival& packet, const FirstPacket& first) {
  ++counts_.packets_ignored;
  const auto out = socket.space();
  if (out.empty()) return;
  constexpr char kWords[] = "the host has as many connections as it may";
  const ngtcp2_ssize size = ngtcp2_crypto_write_connection_close(
      out.data(), out.size(), first.version, &first.client_id, &first.retry_id, NGTCP2_CONNECTION_REFUSED,
      reinterpret_cast<const std::uint8_t*>(kWords), sizeof(kWords) - 1);
  if (size > 0) socket.add(packet.to, packet.from, static_cast<std::size_t>(size));
}

}  // namespace slosh::quic
