// Where the replica was: looked up by when, moved by every correction since.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/math/pose.h"

namespace slosh {

/// A rigid body's motion: centre of mass, axes, twist of the centre of mass; world axes.
struct RigidMotion {
  glm::dvec3 position{0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
  Twist twist;
};

/// a less b: metres, rotation vector, m/s, rad/s.
struct MotionError {
  glm::dvec3 position{0.0};
  glm::dvec3 turn{0.0};
  Twist twist;
};

inline MotionError difference(const RigidMotion& a, const RigidMotion& b) {
  return {a.position - b.position,
          rotation_between(b.orientation, a.orientation),
          {a.twist.linear - b.twist.linear, a.twist.angular - b.twist.angular}};
}

inline MotionError scaled(const MotionError& e, double s) {
  return {s * e.position, s * e.turn, {s * e.twist.linear, s * e.twist.angular}};
}

inline RigidMotion moved(const RigidMotion& m, const MotionError& by) {
  return {m.position + by.position,
          rotate_by(m.orientation, by.turn),
          {m.twist.linear + by.twist.linear, m.twist.angular + by.twist.angular}};
}

/// A ring, newest last. What is corrected now is corrected for all that is in it: entries keep how much had
/// been corrected when they were noted, so that shifting them costs nothing. One thread; allocates when made.
class ReplicaHistory {
 public:
  explicit ReplicaHistory(std::size_t entries) : entries_(entries) {}

  void forget() {
    count_ = 0;
    corrected_ = MotionError{};
    work_corrected_ = 0.0;
  }
  /// `work`: J that what acts besides couplings put in by then; `slosh`: of that what swings did.
  void note(std::int64_t stamp_ns, const RigidMotion& motion, double work = 0.0, double slosh = 0.0) {
    newest_ = (newest_ + 1) % entries_.size();
    if (count_ < entries_.size()) count_ += 1;
    entries_[newest_] = {stamp_ns, motion, corrected_, work - work_corrected_, slosh};
  }
  void correct_work(double by) { work_corrected_ += by; }
  void correct(const MotionError& by) {
    corrected_.position += by.position;
    corrected_.turn += by.turn;  // small: their order does not matter
    corrected_.twist.linear += by.twist.linear;
    corrected_.twist.angular += by.twist.angular;
  }
  /// The motion at `stamp_ns`, between the two entries around it, as corrected by now. False when that is
  /// older than all that is known.
  bool at(std::int64_t stamp_ns, RigidMotion& out) const {
    double work = 0.0, slosh = 0.0;
    return at(stamp_ns, out, work, slosh);
  }
  bool at(std::int64_t stamp_ns, RigidMotion& out, double& work, double& slosh) const {
    if (count_ == 0) return false;
    if (stamp_ns >= entry(0).stamp_ns) {
      out = now(entry(0));
      work = entry(0).work + work_corrected_;
      slosh = entry(0).slosh;
      return true;
    }
    std::size_t low = 0, high = count_;  // entry(low) is younger than the stamp
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (entry(middle).stamp_ns > stamp_ns ? low : high) = middle;
    }
    if (high == count_) return false;
    const RigidMotion older = now(entry(high)), younger = now(entry(low));
    const auto apart = static_cast<double>(entry(low).stamp_ns - entry(high).stamp_ns);
    const double share = apart > 0.0 ? static_cast<double>(stamp_ns - entry(high).stamp_ns) / apart : 0.0;
    out = moved(older, scaled(difference(younger, older), share));
    work = entry(high).work + share * (entry(low).work - entry(high).work) + work_corrected_;
    slosh = entry(high).slosh + share * (entry(low).slosh - entry(high).slosh);
    return true;
  }
  /// The motions after `stamp_ns`, oldest first, as corrected by now, each with its stamp.
  template <class F>
  void since(std::int64_t stamp_ns, F&& each) const {
    std::size_t first = 0;
    while (first < count_ && entry(first).stamp_ns > stamp_ns) first += 1;
    while (first-- > 0) each(entry(first).stamp_ns, now(entry(first)));
  }

 private:
  struct Entry {
    std::int64_t stamp_ns = 0;
    RigidMotion motion;
    MotionError corrected;  // before it was noted
    double work = 0.0;      // less what it had been corrected by
    double slosh = 0.0;
  };
  const Entry& entry(std::size_t back) const {
    return entries_[(newest_ + entries_.size() - back) % entries_.size()];
  }
  RigidMotion now(const Entry& e) const {
    return moved(e.motion, {corrected_.position - e.corrected.position,
                            corrected_.turn - e.corrected.turn,
                            {corrected_.twist.linear - e.corrected.twist.linear,
                             corrected_.twist.angular - e.corrected.twist.angular}});
  }

  std::vector<Entry> entries_;
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  MotionError corrected_;
  double work_corrected_ = 0.0;
};

}  // namespace slosh
