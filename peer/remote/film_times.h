// The moments of a film: exactly one picture each 1/fps of simulated time.
#pragma once

#include <cmath>
#include <cstdint>

namespace slosh {

/// Pictures lie on multiples of 1/fps of the world's time, so that the films of two peers show the same
/// moments. Pure.
class FilmTimes {
 public:
  explicit FilmTimes(double frames_per_second) : fps_(frames_per_second) {}

  /// What there is begins (or begins anew) at `time`.
  void start(double time) {
    next_ = static_cast<std::int64_t>(std::ceil(time * fps_ - 1e-6));
    started_ = true;
  }
  bool started() const { return started_; }
  double next() const { return static_cast<double>(next_) / fps_; }  ///< simulated s
  void taken() { next_ += 1; }

  /// After a gap (a lost connection, a reset): a film that is far behind goes on at `time`, and one that is
  /// far ahead goes back. Short gaps are bridged picture by picture.
  void follow(double time) {
    if (time > next() + kLongestGap || time < next() - kLongestGap) start(time);
  }

 private:
  static constexpr double kLongestGap = 3.0;  // s
  double fps_;
  std::int64_t next_ = 0;
  bool started_ = false;
};

}  // namespace slosh
