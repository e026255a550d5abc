#include "peer/remote/clock_sync.h"

#include <algorithm>
#include <cmath>

#include "net/clock.h"

namespace slosh {
namespace {

constexpr std::int64_t kLongest_ns = 10 * kNanosecondsPerSecond;
constexpr std::int64_t kRange_ns = std::int64_t{1} << 60;  // stamps beyond are nobody's clock
constexpr std::size_t kRecent = 48;
constexpr double kRecentSeconds = 12.0;
constexpr double kDriftBound = 1e-4;    // two ordinary crystals differ by less
constexpr double kLargestDrift = 5e-4;  // what exceeds this in an estimate is ignored
constexpr double kCoarseSeconds = 2.0;
constexpr std::size_t kCoarse = 30;
constexpr double kWorkOff = 1.0;         // s over which a small correction is worked off
constexpr double kContradiction = 0.02;  // s beyond its bounds at which a ping says "another clock"
constexpr int kContradictions = 4;

bool plausible(std::int64_t stamp_ns) {
  return stamp_ns > -kRange_ns && stamp_ns < kRange_ns;
}

std::int64_t seconds_to_ns(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

}  // namespace

bool ClockSync::add(std::int64_t sent_ns, std::int64_t host_received_ns, std::int64_t host_sent_ns,
                    std::int64_t received_ns) {
  if (!plausible(sent_ns) || !plausible(host_received_ns) || !plausible(host_sent_ns) ||
      !plausible(received_ns)) {
    return false;
  }
  const std::int64_t there_and_back = received_ns - sent_ns;
  const std::int64_t at_host = host_sent_ns - host_received_ns;
  if (there_and_back < 0 || there_and_back > kLongest_ns || at_host < 0 || at_host > there_and_back) {
    return false;
  }
  Sample sample;
  sample.at_ns = received_ns;
  sample.round_trip = to_seconds(there_and_back - at_host);
  sample.offset_ns = ((host_received_ns - sent_ns) + (host_sent_ns - received_ns)) / 2;
  last_round_trip_ = sample.round_trip;
  pings_ += 1;

  if (!known_) {
    known_ = true;
    step_to(sample);
    recent_ = {sample};
    return true;
  }
  // Does it contradict the estimate in use, beyond what its round trip and the drift since explain?
  const double apart = std::abs(offset_from_base(sample, received_ns) - mapped_offset(received_ns));
  const double explained = 0.5 * sample.round_trip + error_bound(received_ns) + kContradiction;
  if (apart > explained) {
    contradictions_ += 1;
    if (settled() && contradictions_ < kContradictions) return true;
    // The host was started anew, on another machine perhaps: what was known of its clock is void.
    if (settled()) steps_ += 1;
    recent_ = {sample};
    coarse_.clear();
    drift_ = 0.0;
    step_to(sample);
    return true;
  }
  contradictions_ = 0;
  recent_.push_back(sample);
  while (recent_.size() > kRecent || to_seconds(received_ns - recent_.front().at_ns) > kRecentSeconds) {
    recent_.erase(recent_.begin());
  }
  accepted_ = *std::min_element(recent_.begin(), recent_.end(), [&](const Sample& a, const Sample& b) {
    return cost(a, received_ns) < cost(b, received_ns);
  });
  if (coarse_.empty() || to_seconds(received_ns - coarse_.back().at_ns) > kCoarseSeconds) {
    coarse_.push_back(accepted_);
    if (coarse_.size() > kCoarse) coarse_.erase(coarse_.begin());
    estimate_drift();
  }
  const double wanted = offset_from_base(accepted_, received_ns);
  if (!settled()) {
    step_to(accepted_);
    return true;
  }
  anchor_offset_ = mapped_offset(received_ns);
  anchor_ns_ = received_ns;
  correction_ = wanted - anchor_offset_;
  return true;
}

void ClockSync::restart() {
  pings_ = 0;
  contradictions_ = 0;
}

double ClockSync::cost(const Sample& sample, std::int64_t now_ns) const {
  return 0.5 * sample.round_trip + kDriftBound * to_seconds(now_ns - sample.at_ns);
}

/// The sample's offset carried on to `now_ns` by the drift, s from the base.
double ClockSync::offset_from_base(const Sample& sample, std::int64_t now_ns) const {
  return to_seconds(sample.offset_ns - base_ns_) + drift_ * to_seconds(now_ns - sample.at_ns);
}

double ClockSync::mapped_offset(std::int64_t peer_ns) const {
  const double since = to_seconds(peer_ns - anchor_ns_);
  // A large correction takes as long as the slew allows; a small one kWorkOff, so that noise is smoothed.
  const double speed = std::clamp(correction_ / kWorkOff, -kMaxClockSlew, kMaxClockSlew);
  double worked_off = speed * std::max(since, 0.0);
  if (std::abs(worked_off) > std::abs(correction_)) worked_off = correction_;
  return anchor_offset_ + worked_off + drift_ * since;
}

void ClockSync::estimate_drift() {
  if (coarse_.size() < 5) return;
  // Least squares over the best pings of the last minute. The round trip's asymmetry is the same in all.
  double mean_t = 0.0;
  double mean_o = 0.0;
  const std::int64_t origin_ns = coarse_.front().at_ns;
  for (const Sample& s : coarse_) {
    mean_t += to_seconds(s.at_ns - origin_ns);
    mean_o += to_seconds(s.offset_ns - base_ns_);
  }
  mean_t /= static_cast<double>(coarse_.size());
  mean_o /= static_cast<double>(coarse_.size());
  double over = 0.0;
  double under = 0.0;
  for (const Sample& s : coarse_) {
    const double t = to_seconds(s.at_ns - origin_ns) - mean_t;
    over += t * (to_seconds(s.offset_ns - base_ns_) - mean_o);
    under += t * t;
  }
  if (under < 20.0) return;  // too short a time to tell
  drift_ = std::clamp(over / under, -kLargestDrift, kLargestDrift);
}

void ClockSync::step_to(const Sample& best) {
  base_ns_ = best.offset_ns;
  accepted_ = best;
  anchor_ns_ = best.at_ns;
  anchor_offset_ = 0.0;
  correction_ = 0.0;
}

std::int64_t ClockSync::to_host(std::int64_t peer_ns) const {
  if (!known_) return peer_ns;
  peer_ns = std::clamp(peer_ns, -kRange_ns, kRange_ns);
  return peer_ns + base_ns_ + seconds_to_ns(mapped_offset(peer_ns));
}

std::int64_t ClockSync::to_peer(std::int64_t host_ns) const {
  if (!known_) return host_ns;
  host_ns = std::clamp(host_ns, -kRange_ns, kRange_ns);
  // The mapping's slope is nearly one: each turn makes the error a hundred times smaller.
  std::int64_t peer_ns = host_ns - base_ns_;
  for (int turn = 0; turn < 4; ++turn) peer_ns = host_ns - base_ns_ - seconds_to_ns(mapped_offset(peer_ns));
  return peer_ns;
}

double ClockSync::error_bound(std::int64_t peer_ns) const {
  if (!known_) return 1e9;
  const double not_worked_off = std::abs(offset_from_base(accepted_, peer_ns) - mapped_offset(peer_ns));
  return 0.5 * accepted_.round_trip + kDriftBound * std::max(to_seconds(peer_ns - accepted_.at_ns), 0.0) +
         not_worked_off;
}

double ClockSync::shortest_round_trip() const {
  double shortest = last_round_trip_;
  for (const Sample& sample : recent_) shortest = std::min(shortest, sample.round_trip);
  return shortest;
}

}  // namespace slosh
