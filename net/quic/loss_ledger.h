// Which datagrams never arrived, as opposed to late.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace slosh::quic {

/// ngtcp2 takes a packet for lost as soon as three later ones are acknowledged, and forgets it: where a link
/// lets some packets overtake others, more than half of what it calls lost has arrived. Here a packet is lost
/// when it is still not acknowledged some time after it was sent and a later one is. Reads no clock.
class LossLedger {
 public:
  /// A packet of `bytes` with so many datagrams in it. Numbers rise; what is skipped was none of ours.
  void sent(std::int64_t number, unsigned datagrams, std::size_t bytes, std::int64_t now) {
    if (entries_.empty()) first_ = number;
    while (first_ + static_cast<std::int64_t>(entries_.size()) < number)
      entries_.push_back({now, 0, 0, false});
    entries_.push_back({now, bytes, datagrams, false});
    under_way_ += bytes;
    if (entries_.size() > kMax) drop_first();
  }
  /// Both ends count. What was not sent is left alone.
  void acknowledged(std::int64_t from, std::int64_t to) {
    const std::int64_t end = first_ + static_cast<std::int64_t>(entries_.size());
    if (to >= end) to = end - 1;
    if (from < first_) from = first_;
    for (std::int64_t number = from; number <= to; ++number) at(number).arrived = true;
    for (std::int64_t number = std::max(first_, newest_ + 1); number <= to; ++number)
      under_way_ -= at(number).bytes;
    newest_ = std::max(newest_, to);
  }
  /// Gives up what was sent longer ago than `patience_ns` and overtaken.
  void settle(std::int64_t now, std::int64_t patience_ns) {
    while (!entries_.empty() && first_ <= newest_ &&
           (entries_.front().arrived || now - entries_.front().sent_ns > patience_ns))
      drop_first();
  }
  std::uint64_t lost() const { return lost_; }  ///< datagrams
  /// Bytes sent after the newest packet that is acknowledged: what the way and its queues hold, whatever was
  /// lost.
  std::size_t under_way() const { return under_way_; }
  std::size_t size() const { return entries_.size(); }

 private:
  static constexpr std::size_t kMax = 16384;  // packets
  struct Entry {
    std::int64_t sent_ns;
    std::size_t bytes;
    unsigned datagrams;
    bool arrived;
  };
  Entry& at(std::int64_t number) { return entries_[static_cast<std::size_t>(number - first_)]; }
  void drop_first() {
    if (!entries_.front().arrived) lost_ += entries_.front().datagrams;
    if (first_ > newest_) under_way_ -= entries_.front().bytes;
    entries_.pop_front();
    ++first_;
  }

  std::deque<Entry> entries_;
  std::int64_t first_ = 0;    // the number of entries_.front()
  std::int64_t newest_ = -1;  // acknowledged
  std::size_t under_way_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace slosh::quic
