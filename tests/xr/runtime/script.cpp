#include "tests/xr/runtime/script.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <sstream>

namespace slosh::xr_test {

Script Script::read() {
  Script script;
  script.hands[0].at.x = -0.15;
  script.hands[1].at.x = 0.15;
  const char* folder = std::getenv("SLOSH_TEST_XR");
  script.folder = folder ? folder : ".";
  std::ifstream file(script.folder / "script.txt");
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    const auto hand = [&]() -> ScriptedHand& {
      std::string side;
      words >> side;
      return script.hands[side == "right" ? 1 : 0];
    };
    if (word == "runtime") std::getline(words >> std::ws, script.name);
    if (word == "headset") words >> script.headset;
    if (word == "egl") words >> script.egl;
    if (word == "stage") words >> script.stage;
    if (word == "size") words >> script.width >> script.height;
    if (word == "rate") words >> script.rate;
    if (word == "ipd") words >> script.ipd;
    if (word == "head") words >> script.head.x >> script.head.y >> script.head.z;
    if (word == "hand") {
      ScriptedHand& h = hand();
      words >> h.at.x >> h.at.y >> h.at.z;
    }
    if (word == "swing") {
      ScriptedHand& h = hand();
      words >> h.swing.x >> h.swing.y >> h.swing.z >> h.period;
    }
    if (word == "squeeze") {
      ScriptedHand& h = hand();
      words >> h.squeeze_from >> h.squeeze_until;
    }
    if (word == "no_hand") hand().there = false;
    std::uint64_t frame = 0;
    if (word == "keep" && words >> frame) script.kept.insert(frame);
    if (word == "at" && words >> frame) {
      Happening happening;
      std::getline(words >> std::ws, happening.what);
      script.happenings.emplace(frame, happening);
    }
  }
  return script;
}

void Log::open(const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  out_.close();
  out_.open(file, std::ios::app);
}

void Log::say(const char* pattern, ...) {
  char text[400];
  va_list values;
  va_start(values, pattern);
  std::vsnprintf(text, sizeof text, pattern, values);
  va_end(values);
  const std::lock_guard lock(mutex_);
  out_ << text << std::endl;
}

Pose hand_pose(const ScriptedHand& hand, double seconds) {
  const double share = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * seconds / hand.period);
  return {hand.at + share * hand.swing, {1.0, 0.0, 0.0, 0.0}};
}

Twist hand_twist(const ScriptedHand& hand, double seconds) {
  const double turn = 2.0 * std::numbers::pi / hand.period;
  return {0.5 * turn * std::sin(turn * seconds) * hand.swing, {}};
}

}  // namespace slosh::xr_test
