// The qualities that snapshots are sent in, and which one suits a peer's link.
#pragma once

#include <array>
#include <cstdint>

namespace slosh {

/// What a stream of the codec is made with. Better ones first; a tier's number is its stream's.
struct Tier {
  double tolerance = 0.001;  ///< m
  bool shell_only = false;
  unsigned every = 1;  ///< takes every n-th snapshot of the host's 60 a second
  const char* words = "";
};
constexpr std::array kTiers{
    Tier{0.001, false, 1, "all particles, 1 mm, 60 Hz"}, Tier{0.001, false, 2, "all particles, 1 mm, 30 Hz"},
    Tier{0.001, true, 2, "what is seen, 1 mm, 30 Hz"},   Tier{0.002, true, 2, "what is seen, 2 mm, 30 Hz"},
    Tier{0.002, true, 4, "what is seen, 2 mm, 15 Hz"},   Tier{0.004, true, 8, "what is seen, 4 mm, 7.5 Hz"},
};
constexpr int kTierCount = static_cast<int>(kTiers.size());
constexpr double kTierSnapshotRate = 60.0;  ///< Hz of simulated time
constexpr int kAllParticles = 0;
constexpr int kShell = 2;

/// What was seen of a link since the last time, a tenth of a second or so.
struct LinkEvidence {
  std::uint32_t frames = 0;           ///< that were due
  std::uint32_t frames_withheld = 0;  ///< of those, for want of room in the queue
  std::uint32_t pieces_sent = 0;      ///< as the peer reckons
  std::uint32_t pieces_came = 0;
  bool datagrams_dropped = false;  ///< snapshot datagrams fell out of the queue
  double rtt = 0.0;                ///< s, smoothed
  double min_rtt = 0.0;            ///< s
  bool silent = false;             ///< the peer has not told for long what came
};

/// Chooses a tier by what a link does: down soon when it is too full, up carefully, and more carefully each
/// time that up was too much. Loss that is not the link's fullness (up to 15 %) does not count. Pure.
class TierControl {
 public:
  /// `best` is the lowest number that may be chosen.
  TierControl(int best, int start) : best_(best), tier_(start) {}
  int tier() const { return tier_; }
  /// True when the tier is another now.
  bool note(const LinkEvidence& seen, std::int64_t now_ns);

 private:
  bool congested(const LinkEvidence& seen);
  int best_;
  int tier_;
  double loss_ = 0.0;                // smoothed share of pieces that did not come
  std::int64_t changed_ns_ = 0;      // last change of tier
  std::int64_t full_since_ns_ = 0;   // 0 = not congested
  std::int64_t clear_since_ns_ = 0;  // 0 = congested
  bool climbed_ = false;             // the last change was up
  double patience_ = 2.0;            // s of clear link before the next climb
};

}  // namespace slosh
