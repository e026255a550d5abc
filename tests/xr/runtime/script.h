// What the runtime of the tests is to be and to do: a file of lines, read when an instance is made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "sim/math/pose.h"

namespace slosh::xr_test {

/// One thing that happens before a frame is begun: its number counts xrWaitFrame from 1, over all sessions.
struct Happening {
  std::string what;  ///< "state NAME", "lose", "fail CALL TIMES"
  bool done = false;
};

/// A controller: where it is, and when it is squeezed.
struct ScriptedHand {
  bool there = true;
  glm::dvec3 at{0.0, 1.0, -0.4};  ///< m, room
  glm::dvec3 swing{0.0};          ///< m: it goes there and back, (1 − cos)/2
  double period = 2.0;            ///< s of that
  double squeeze_from = 0.0;      ///< s after the session began
  double squeeze_until = 1e9;
};

/// `$SLOSH_TEST_XR/script.txt`, one wish a line:
///   runtime NAME · headset 0|1 · egl 0|1 · stage 0|1 · size W H · rate HZ · ipd M · head X Y Z · keep FRAME
///   at FRAME state NAME · at FRAME lose · at FRAME fail CALL TIMES
///   hand left|right X Y Z · swing left|right X Y Z PERIOD · squeeze left|right FROM UNTIL · no_hand
///   left|right
/// What it sees goes to `$SLOSH_TEST_XR/log.txt`, kept frames beside it as `frame-N-left.ppm` and so on.
struct Script {
  std::filesystem::path folder;
  std::string name = "Test runtime";
  bool headset = true;
  bool egl = true;
  bool stage = true;
  int width = 160;
  int height = 160;
  double rate = 90.0;
  double ipd = 0.064;
  glm::dvec3 head{0.0, 1.6, 0.0};
  ScriptedHand hands[2];
  std::multimap<std::uint64_t, Happening> happenings;
  std::set<std::uint64_t> kept;

  static Script read();
};

/// Lines, each whole at once: other threads log too.
class Log {
 public:
  void open(const std::filesystem::path& file);
  void say(const char* pattern, ...) __attribute__((format(printf, 2, 3)));

 private:
  std::mutex mutex_;
  std::ofstream out_;
};

/// Where that hand is `seconds` after the session began, and how fast.
Pose hand_pose(const ScriptedHand& hand, double seconds);
Twist hand_twist(const ScriptedHand& hand, double seconds);

}  // namespace slosh::xr_test
