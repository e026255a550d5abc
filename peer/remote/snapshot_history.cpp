#include "peer/remote/snapshot_history.h"

#include <algorithm>

namespace slosh {
namespace {

constexpr std::size_t kMaxHistoryBytes = std::size_t{256} << 20;
constexpr std::size_t kFewestFrames = 4;  // whatever their size
constexpr std::size_t kMaxBodies = 2048;
constexpr std::size_t kMaxHands = 1024;    // samples of one hand
constexpr std::size_t kMaxGrips = 64;      // as the wire has it
constexpr double kHandFresh = 0.2;         // s for which a hand without updates is where it was
constexpr double kSameTime = 1e-9;         // s
constexpr double kBetweenBodies = 0.0035;  // s: denser states tell a snapshot nothing

std::size_t size_of(const DecodedFrame& frame) {
  return sizeof(DecodedFrame) + frame.positions.size() * sizeof(glm::vec3) + frame.fluid_index.size();
}

/// The shorter list is then the longer one's beginning: an epoch may grow.
bool same_particles(const DecodedFrame& a, const DecodedFrame& b) {
  return a.epoch == b.epoch;
}

glm::dvec3 mixed(const glm::dvec3& a, const glm::dvec3& b, double share) {
  return a + share * (b - a);
}
Pose mixed(const Pose& a, const Pose& b, double share) {
  return {mixed(a.position, b.position, share),
          rotate_by(a.orientation, share * rotation_between(a.orientation, b.orientation))};
}
Twist mixed(const Twist& a, const Twist& b, double share) {
  return {mixed(a.linear, b.linear, share), mixed(a.angular, b.angular, share)};
}
Wrench mixed(const Wrench& a, const Wrench& b, double share) {
  return {mixed(a.force, b.force, share), mixed(a.torque, b.torque, share)};
}

double share_between(double before, double after, double time) {
  return after - before < kSameTime ? 0.0 : std::clamp((time - before) / (after - before), 0.0, 1.0);
}

}  // namespace

BodySnapshot blend(const BodySnapshot& a, const BodySnapshot& b, double time) {
  const double share = share_between(a.time, b.time, time);
  BodySnapshot out = a;
  out.time = time;
  out.status = a.status | b.status;
  for (std::size_t i = 0; i < out.bodies.size() && i < b.bodies.size(); ++i) {
    BodyState& s = out.bodies[i];
    if (s.away() != b.bodies[i].away()) continue;  // it comes, or goes, at once
    s.pose = mixed(s.pose, b.bodies[i].pose, share);
    s.twist = mixed(s.twist, b.bodies[i].twist, share);
    s.center_of_mass = mixed(s.center_of_mass, b.bodies[i].center_of_mass, share);
    s.fluid = mixed(s.fluid, b.bodies[i].fluid, share);
  }
  for (std::size_t i = 0; i < out.grips.size() && i < b.grips.size(); ++i) {
    GripState& s = out.grips[i];
    if (is_away(s.pose) != is_away(b.grips[i].pose)) continue;
    s.pose = mixed(s.pose, b.grips[i].pose, share);
    s.twist = mixed(s.twist, b.grips[i].twist, share);
    s.handle = mixed(s.handle, b.grips[i].handle, share);
    s.on_hand = mixed(s.on_hand, b.grips[i].on_hand, share);
  }
  return out;
}

std::shared_ptr<Snapshot> blend(const Between& between) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->rigid = between.rigid;
  if (!between.before) return snapshot;
  const DecodedFrame& a = *between.before;
  const DecodedFrame& b = *between.after;
  const auto share = static_cast<float>(between.share);
  const std::size_t count = std::min(a.positions.size(), b.positions.size());
  snapshot->positions.resize(count);
  snapshot->fluid_index.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    snapshot->positions[i] = a.positions[i] + share * (b.positions[i] - a.positions[i]);
    // 255, out of the world, is the larger of the two.
    snapshot->fluid_index[i] = std::max(a.fluid_index[i], b.fluid_index[i]);
  }
  return snapshot;
}

void SnapshotHistory::follow_run(std::uint32_t run) {
  if (!any_run_ && run == run_) return;
  run_ = run;
  any_run_ = false;
  frames_.clear();
  bodies_.clear();
  hands_.clear();
  bytes_ = 0;
}

void SnapshotHistory::add(DecodedFrame frame) {
  if (!any_run_ && frame.run < run_) return;
  if (frame.fluid_index.size() != frame.positions.size()) return;
  follow_run(frame.run);
  if (!frames_.empty() && frame.time < frames_.back()->time - kSameTime) return;
  bytes_ += size_of(frame);
  frames_.push_back(std::make_shared<const DecodedFrame>(std::move(frame)));
  bound();
}

void SnapshotHistory::add(std::uint32_t run, const BodySnapshot& bodies) {
  if (!any_run_ && run < run_) return;
  follow_run(run);
  if (!bodies_.empty() && bodies.time < bodies_.back().time + kSameTime) {
    if (bodies.time > bodies_.back().time - kSameTime) bodies_.back() = bodies;
    return;
  }
  // The newest is always there; the one before it only when it is far enough from its neighbour.
  const std::size_t n = bodies_.size();
  if (n >= 2 && bodies.time - bodies_[n - 2].time < kBetweenBodies) bodies_.pop_back();
  bodies_.push_back(bodies);
  if (bodies_.size() > kMaxBodies) bodies_.pop_front();
}

void SnapshotHistory::add_hand(std::uint32_t run, std::size_t grip, double time, const Pose& pose,
                               bool engaged) {
  if (any_run_ || run != run_ || grip >= kMaxGrips) return;
  if (grip >= hands_.size()) hands_.resize(grip + 1);
  std::deque<HandSample>& samples = hands_[grip];
  // While the world stands still its time does too, and the newest counts.
  while (!samples.empty() && samples.back().time >= time - kSameTime) samples.pop_back();
  samples.push_back({time, pose, engaged});
  if (samples.size() > kMaxHands) samples.pop_front();
}

void SnapshotHistory::place_hands(BodySnapshot& rigid) const {
  for (std::size_t i = 0; i < hands_.size() && i < rigid.grips.size(); ++i) {
    const std::deque<HandSample>& samples = hands_[i];
    const auto after = std::lower_bound(samples.begin(), samples.end(), rigid.time,
                                        [](const HandSample& s, double t) { return s.time < t; });
    if (after == samples.begin()) continue;
    const HandSample& before = *std::prev(after);
    if (!before.engaged || rigid.time - before.time > kHandFresh) continue;
    const bool between = after != samples.end() && after->engaged;
    rigid.grips[i].handle =
        between ? mixed(before.pose, after->pose, share_between(before.time, after->time, rigid.time))
                : before.pose;
  }
}

void SnapshotHistory::restart() {
  any_run_ = true;
  hands_.clear();
}

void SnapshotHistory::bound() {
  while (bytes_ > kMaxHistoryBytes && frames_.size() > kFewestFrames) {
    bytes_ -= size_of(*frames_.front());
    frames_.pop_front();
  }
}

std::optional<Between> SnapshotHistory::at(double time) const {
  if (frames_.empty() && bodies_.empty()) return std::nullopt;
  Between out;
  if (!frames_.empty()) {
    // The first pair of one epoch around the time: at an epoch's start there is one on either side.
    const std::shared_ptr<const DecodedFrame>* before = nullptr;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const bool reached = frames_[i]->time >= time - kSameTime;
      if (!reached) {
        before = &frames_[i];
        continue;
      }
      for (std::size_t j = i; j-- > 0;) {
        if (frames_[j]->time > time + kSameTime) continue;
        if (!same_particles(*frames_[j], *frames_[i])) continue;
        out.before = frames_[j];
        out.after = frames_[i];
        out.share = share_between(out.before->time, out.after->time, time);
        break;
      }
      if (out.before) break;
      // Nothing of its own order comes before it: it serves when the time is its own.
      if (frames_[i]->time <= time + kSameTime) before = &frames_[i];
      if (frames_[i]->time > time + kSameTime + 1.0) break;
    }
    if (!out.before) out.before = out.after = before != nullptr ? *before : frames_.front();
  }
  if (bodies_.empty()) {
    out.rigid.time = time;
    return out;
  }
  const auto after = std::lower_bound(bodies_.begin(), bodies_.end(), time,
                                      [](const BodySnapshot& s, double t) { return s.time < t; });
  if (after == bodies_.end()) {
    out.rigid = bodies_.back();
  } else if (after == bodies_.begin()) {
    out.rigid = bodies_.front();
  } else {
    out.rigid = blend(*std::prev(after), *after, time);
  }
  out.rigid.time = time;
  place_hands(out.rigid);
  return out;
}

void SnapshotHistory::forget_before(double time) {
  // The last instant at or before the time stays, in every order that it has.
  double keep = -1e300;
  for (const auto& frame : frames_) {
    if (frame->time <= time + kSameTime) keep = frame->time;
  }
  while (!frames_.empty() && frames_.front()->time < keep - kSameTime) {
    bytes_ -= size_of(*frames_.front());
    frames_.pop_front();
  }
  while (bodies_.size() > 1 && bodies_[1].time < time - kSameTime) bodies_.pop_front();
  for (std::deque<HandSample>& samples : hands_) {
    while (samples.size() > 1 && samples[1].time < time - kSameTime) samples.pop_front();
  }
}

}  // namespace slosh
