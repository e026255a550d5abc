// What a Connection sends, and in which order.
#include <algorithm>
#include <utility>

#include "net/quic/connection.h"

namespace slosh::quic {
namespace {

constexpr std::size_t kDatagramOverhead = 3;  // frame type and length
constexpr std::size_t kProbeByteSize = 8;     // the frame: type, stream, offset, length, a byte
// Room for frames in a packet of ours: less header, packet number and tag.
constexpr std::size_t kRoom = kMaxPacket - 1 - 20 - 4 - 16 - (kDatagramsAreProbed ? 0 : kProbeByteSize);
// Streams come last, but a full link must not silence them: one packet of theirs after so many snapshots.
constexpr std::size_t kSnapshotsAStream = 15;
// ns: so often a packet of poses or states leaves however full the link looks (30 kB/s at most). The queue
// may be the other way's.
constexpr std::int64_t kMinEvery = 40'000'000;
// Who hears nothing for two round trips and kDeaf, s, sends a packet each kDeafEvery, ns: what goes into the
// dark counts as under way until something later is acknowledged, and would fill the window of a path that is
// new.
constexpr double kDeaf = 0.1;
constexpr std::int64_t kDeafEvery = 100'000'000;
constexpr double kBurst = 2e-3;  // s of the link's rate that may leave at once
constexpr double kLate = 0.3;    // s after which what others overtook counts as lost, at least

}  // namespace

void Connection::flush(std::int64_t now) {
  if (state_ == State::kClosed) return;
  if (state_ == State::kLingering && streams_.settled()) {
    abort(parting_.code, parting_.text, now);
    return;
  }
  streams_.unblock_all();
  PathFigures figures = path_figures(conn_);
  const std::size_t limit = burst(figures);
  rate_ =
      delivered_rate_.note(bytes_sent_ - std::min(bytes_sent_, figures.in_flight), now, figures.smoothed_rtt);
  figures.delivery_rate = rate_;
  const std::size_t most = snapshot_room_.limit(figures, now);
  room_ = most > figures.in_flight ? most - figures.in_flight : 0;
  const std::size_t wide = pose_room_.limit(figures, now);
  held_back_ = wide != SIZE_MAX;
  if (ledger_.under_way() == 0) idle_until_ = now;
  const double silence = 1e-9 * static_cast<double>(now - std::max(idle_until_, last_received_));
  const bool deaf = silence > kDeaf + 2.0 * figures.smoothed_rtt;
  const auto patience = static_cast<std::int64_t>(1e9 * std::max(kLate, 2.0 * figures.smoothed_rtt));
  ledger_.settle(now, patience);
  std::size_t sent = 0;
  std::size_t bulk = 0;
  bulk_waits_ = false;
  ngtcp2_path_storage path;
  Connection* const outer = std::exchange(writing, this);
  while (sent < limit) {
    const std::span<std::uint8_t> out = socket_->space();
    if (out.empty()) break;
    ngtcp2_path_storage_zero(&path);
    short_packet_ = bulk_packet_ = false;
    packed_datagrams_ = 0;
    const bool crowded = deaf || ledger_.under_way() >= wide;
    const bool full = crowded && now - datagrams_left_ < (deaf ? kDeafEvery : kMinEvery);
    const ngtcp2_ssize size = full ? ngtcp2_conn_write_pkt(conn_, &path.path, nullptr, out.data(), out.size(),
                                                           static_cast<ngtcp2_tstamp>(now))
                                   : write_packet(out, &path.path, now);
    if (size < 0) {
      writing = outer;
      fail(static_cast<int>(size), now);
      return;
    }
    if (size == 0) break;
    if (packed_datagrams_ > 0) datagrams_left_ = now;
    if (short_packet_) ledger_.sent(packet_number_, packed_datagrams_, static_cast<std::size_t>(size), now);
    socket_->add(Address(path.path.local.addr, path.path.local.addrlen),
                 Address(path.path.remote.addr, path.path.remote.addrlen), static_cast<std::size_t>(size));
    sent += static_cast<std::size_t>(size);
    if (bulk_packet_) bulk += static_cast<std::size_t>(size);
    room_ -= std::min(room_, static_cast<std::size_t>(size));
  }
  writing = outer;
  bytes_sent_ += sent;
  pace(sent, bulk, now);
}

/// Snapshots and streams keep the pace; poses and states, which are little and steady, do not wait for it.
bool Connection::bulk_allowed(std::int64_t now) {
  if (now >= bulk_due_) return true;
  bulk_waits_ = true;
  return false;
}

/// Says when the next packets may leave: the library's pace, times the gain.
void Connection::pace(std::size_t sent, std::size_t bulk, std::int64_t now) {
  const PathFigures figures = path_figures(conn_);
  const bool waiting = queues_.next() >= 0 && room_ > 0 && figures.in_flight + kMaxPacket <= figures.window;
  std::uint64_t datagrams = 0;
  for (const std::uint64_t count : counts_.datagrams_sent) datagrams += count;
  pace_.note(figures, waiting, datagrams, counts_.datagrams_lost, now);
  // The library adds `sent` / pace to the time that it is told: an earlier one makes the pause shorter.
  // While the link shows no queue poses and states keep their own pace, and the pause is for the others.
  const double shorter = held_back_ ? 1.0 - 1.0 / pace_.factor() : 1.0;
  std::int64_t told = now;
  if (figures.pacing_rate > 0.0) {
    told -= static_cast<std::int64_t>(1e9 * static_cast<double>(sent) / figures.pacing_rate * shorter);
    const double pause = static_cast<double>(bulk) / (figures.pacing_rate * pace_.factor());
    if (!held_back_ && bulk > 0) bulk_due_ = now + static_cast<std::int64_t>(1e9 * pause);
  }
  ngtcp2_conn_update_pkt_tx_time(conn_, static_cast<ngtcp2_tstamp>(told));
}

/// A pose that comes right after a burst waits for the pace to allow the next one: so bursts are short.
std::size_t Connection::burst(const PathFigures& figures) const {
  const std::size_t quantum = ngtcp2_conn_get_send_quantum(conn_);
  const double rate = figures.pacing_rate;
  if (rate <= 0.0) return quantum;
  const double bytes = std::min(pace_.factor() * rate * kBurst, 65536.0);
  return std::max<std::size_t>(static_cast<std::size_t>(bytes), 2 * kMaxPacket);
}

/// One packet into `out`: its size, 0 when nothing may or need be sent, or an error of the library.
ngtcp2_ssize Connection::write_packet(std::span<std::uint8_t> out, ngtcp2_path* path, std::int64_t now) {
  std::size_t packed = 0;
  bool probed = false;
  if (probe_stream_due_) {
    const ngtcp2_ssize size = write_probe_byte(out, path, false, now);
    if (size != NGTCP2_ERR_STREAM_DATA_BLOCKED) return size;
  }
  while (state_ == State::kOpen || state_ == State::kLingering) {
    int priority = queues_.next();
    if (priority == static_cast<int>(Priority::kSnapshot) && (room_ == 0 || !bulk_allowed(now)))
      priority = -1;
    const bool snapshot = priority == static_cast<int>(Priority::kSnapshot);
    const bool stream_turn = priority < 0 || (snapshot && snapshots_in_a_row_ >= kSnapshotsAStream);
    if (stream_turn && streams_.pending() && bulk_allowed(now)) {
      snapshots_in_a_row_ = 0;
      bulk_packet_ = true;
      const ngtcp2_ssize size = write_stream(out, path, now);
      if (size == NGTCP2_ERR_STREAM_DATA_BLOCKED || size == NGTCP2_ERR_STREAM_SHUT_WR ||
          size == NGTCP2_ERR_STREAM_NOT_FOUND)
        continue;
      return size;
    }
    if (priority < 0) break;
    if (!kDatagramsAreProbed && packed == 0 && !probed) {
      probed = true;
      const ngtcp2_ssize size = write_probe_byte(out, path, true, now);
      if (size > 0) return size;
      // 0 may be the streams' flow control, which datagrams know nothing of.
      if (size != 0 && size != NGTCP2_ERR_WRITE_MORE && size != NGTCP2_ERR_STREAM_DATA_BLOCKED &&
          size != NGTCP2_ERR_STREAM_NOT_FOUND)
        return size;
    }
    bool accepted = false;
    const ngtcp2_ssize size = write_datagram(out, path, priority, accepted, packed, now);
    if (accepted) {
      packed += queues_.front(priority)->size() + kDatagramOverhead;
      ++counts_.datagrams_sent[priority];
      ++packed_datagrams_;
      snapshots_in_a_row_ = snapshot ? snapshots_in_a_row_ + 1 : snapshots_in_a_row_;
      bulk_packet_ = bulk_packet_ || snapshot;
      queues_.pop(priority);
    }
    if (size == NGTCP2_ERR_WRITE_MORE) continue;
    if (size == NGTCP2_ERR_INVALID_ARGUMENT || size == NGTCP2_ERR_INVALID_STATE) {
      queues_.pop(priority);  // the other side cannot take one as long
      continue;
    }
    return size;
  }
  return ngtcp2_conn_write_pkt(conn_, path, nullptr, out.data(), out.size(), static_cast<ngtcp2_tstamp>(now));
}

ngtcp2_ssize Connection::write_datagram(std::span<std::uint8_t> out, ngtcp2_path* path, int priority,
                                        bool& accepted, std::size_t packed, std::int64_t now) {
  const SharedBytes& bytes = queues_.front(priority);
  const std::size_t after = queues_.size_after_next();
  const bool more = after > 0 && packed + bytes->size() + after + 2 * kDatagramOverhead <= kRoom;
  ngtcp2_vec vector{const_cast<std::uint8_t*>(bytes->data()), bytes->size()};
  int taken = 0;
  const ngtcp2_ssize size =
      ngtcp2_conn_writev_datagram(conn_, path, nullptr, out.data(), out.size(), &taken,
                                  more ? NGTCP2_WRITE_DATAGRAM_FLAG_MORE : NGTCP2_WRITE_DATAGRAM_FLAG_NONE, 0,
                                  &vector, 1, static_cast<ngtcp2_tstamp>(now));
  accepted = taken != 0;
  return size;
}

ngtcp2_ssize Connection::write_probe_byte(std::span<std::uint8_t> out, ngtcp2_path* path, bool more,
                                          std::int64_t now) {
  static std::uint8_t byte = 0;  // the library looks at it until it is acknowledged
  const ngtcp2_vec vector{&byte, 1};
  ngtcp2_ssize taken = -1;
  const ngtcp2_ssize size =
      ngtcp2_conn_writev_stream(conn_, path, nullptr, out.data(), out.size(), &taken,
                                more ? NGTCP2_WRITE_STREAM_FLAG_MORE : NGTCP2_WRITE_STREAM_FLAG_NONE,
                                kProbeStream, &vector, 1, static_cast<ngtcp2_tstamp>(now));
  if (taken == 1) probe_stream_due_ = false;
  return size;
}

ngtcp2_ssize Connection::write_stream(std::span<std::uint8_t> out, ngtcp2_path* path, std::int64_t now) {
  const std::int64_t stream = streams_.next();
  ngtcp2_vec vectors[4];
  bool end = false;
  const std::size_t count = streams_.gather(stream, vectors, end);
  ngtcp2_ssize taken = -1;
  const ngtcp2_ssize size =
      ngtcp2_conn_writev_stream(conn_, path, nullptr, out.data(), out.size(), &taken,
                                end ? NGTCP2_WRITE_STREAM_FLAG_FIN : NGTCP2_WRITE_STREAM_FLAG_NONE, stream,
                                vectors, count, static_cast<ngtcp2_tstamp>(now));
  if (size == NGTCP2_ERR_STREAM_DATA_BLOCKED)
    streams_.block(stream);
  else if (size == NGTCP2_ERR_STREAM_SHUT_WR || size == NGTCP2_ERR_STREAM_NOT_FOUND)
    streams_.abandon(stream);
  else if (taken >= 0)
    streams_.sent(stream, static_cast<std::size_t>(taken), end);
  return size;
}

void Connection::write_close(const CloseError& error, std::int64_t now) {
  std::uint8_t packet[kMaxPacket];
  ngtcp2_path_storage path;
  ngtcp2_path_storage_zero(&path);
  const ngtcp2_ssize size = ngtcp2_conn_write_connection_close(
      conn_, &path.path, nullptr, packet, sizeof(packet), &error, static_cast<ngtcp2_tstamp>(now));
  if (size <= 0) return;
  close_packet_.assign(packet, packet + size);
  const std::span<std::uint8_t> out = socket_->space();
  if (out.empty()) return;
  std::copy(close_packet_.begin(), close_packet_.end(), out.begin());
  socket_->add(Address(path.path.local.addr, path.path.local.addrlen),
               Address(path.path.remote.addr, path.path.remote.addrlen), close_packet_.size());
  bytes_sent_ += close_packet_.size();
}

}  // namespace slosh::quic
