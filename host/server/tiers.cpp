#include "host/server/tiers.h"

#include <algorithm>

#include "net/clock.h"

namespace slosh {
namespace {

constexpr double kHeavyLoss = 0.15;    // share of pieces; beyond, it is the link's fullness
constexpr double kFullFor = 0.25;      // s of a full link before a step down
constexpr double kAftermath = 0.5;     // s after a change in which the old tier's datagrams still count
constexpr double kFailedClimb = 6.0;   // s: a fall so soon after a climb makes the next climb wait longer
constexpr double kMaxPatience = 60.0;  // s

}  // namespace

bool TierControl::congested(const LinkEvidence& seen) {
  if (seen.pieces_sent > 0) {
    const double came = static_cast<double>(std::min(seen.pieces_came, seen.pieces_sent));
    const double lost = 1.0 - came / static_cast<double>(seen.pieces_sent);
    // A tenth of a second has few pieces: one unlucky lot must not decide.
    const double weight = std::min(0.5, 0.01 * static_cast<double>(seen.pieces_sent));
    loss_ += weight * (lost - loss_);
  }
  const bool withheld = seen.frames_withheld * 10 > seen.frames;
  const bool queueing = seen.min_rtt > 0.0 && seen.rtt > 2.0 * seen.min_rtt + 0.04;
  return withheld || queueing || seen.datagrams_dropped || seen.silent || loss_ > kHeavyLoss;
}

bool TierControl::note(const LinkEvidence& seen, std::int64_t now_ns) {
  if (changed_ns_ == 0) changed_ns_ = now_ns;
  const bool full = congested(seen);
  if (now_ns - changed_ns_ < to_nanoseconds(kAftermath)) return false;
  if (full) {
    clear_since_ns_ = 0;
    if (full_since_ns_ == 0) full_since_ns_ = now_ns;
    if (now_ns - full_since_ns_ < to_nanoseconds(kFullFor) || tier_ == kTierCount - 1) return false;
    if (climbed_ && now_ns - changed_ns_ < to_nanoseconds(kFailedClimb))
      patience_ = std::min(2.0 * patience_, kMaxPatience);
    // Far too full: two steps at once.
    const int steps = seen.frames > 0 && seen.frames_withheld * 2 > seen.frames ? 2 : 1;
    tier_ = std::min(tier_ + steps, kTierCount - 1);
    climbed_ = false;
  } else {
    full_since_ns_ = 0;
    if (clear_since_ns_ == 0) clear_since_ns_ = now_ns;
    if (tier_ <= best_ || now_ns - clear_since_ns_ < to_nanoseconds(patience_)) return false;
    tier_ -= 1;
    climbed_ = true;
  }
  changed_ns_ = now_ns;
  full_since_ns_ = clear_since_ns_ = 0;
  loss_ = 0.0;
  return true;
}

}  // namespace slosh
