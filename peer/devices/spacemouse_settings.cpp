#include "peer/devices/spacemouse_settings.h"

#include <algorithm>

#include "peer/devices/spacemouse_reports.h"

namespace slosh {
namespace {

constexpr std::array<const char*, 6> kAxisNames{"x", "y", "z", "rx", "ry", "rz"};

void read_axes(DeviceFile& file, SpaceMouseSettings& settings) {
  const std::optional<std::vector<std::string>> words = file.list("axes");
  if (!words) return;
  constexpr const char* kMend =
      "Give six of the device's axes for the hand's x y z rx ry rz, each with '-' to turn it round, "
      "for example: axes = x -z y -rx rz -ry";
  if (words->size() != 6) {
    file.refuse("axes", "axes has " + std::to_string(words->size()) + " entries", kMend);
    return;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string& word = (*words)[i];
    const bool negative = !word.empty() && word[0] == '-';
    const auto at = std::find(kAxisNames.begin(), kAxisNames.end(), word.substr(negative ? 1 : 0));
    if (at == kAxisNames.end()) {
      file.refuse("axes", "entry " + std::to_string(i + 1) + " of axes is no axis", kMend);
      return;
    }
    settings.axes[i] = {static_cast<int>(at - kAxisNames.begin()), negative ? -1.0 : 1.0};
  }
}

}  // namespace

Result<SpaceMouseSettings> read_spacemouse_settings(DeviceFile file, const SpaceMouseSettings& otherwise) {
  SpaceMouseSettings s = otherwise;
  s.rate = file.word("mode", s.rate ? "rate" : "position", {"rate", "position"}) == "rate";
  s.by_camera = file.word("relative_to", s.by_camera ? "camera" : "world", {"camera", "world"}) == "camera";
  s.deadzone = file.whole("deadzone", s.deadzone, 0, kSpaceMouseFull - 1);
  s.speed = file.number("speed_m_s", s.speed, 0.0, 5.0);
  s.turn_rate = file.number("turn_rad_s", s.turn_rate, 0.0, 20.0);
  s.reach = file.number("reach_m", s.reach, 0.0, 2.0);
  s.turn = file.number("reach_rad", s.turn, 0.0, 3.0);
  read_axes(file, s);
  for (std::size_t i = 0; i < 6; ++i)
    s.gains[i] = file.number(std::string("gain_") + kAxisNames[i], s.gains[i], -10.0, 10.0);
  s.clutch_button = file.whole("clutch_button", s.clutch_button, 0, kMaxButtons);
  s.deadman_button = file.whole("deadman_button", s.deadman_button, 0, kMaxButtons);
  if (const Result<bool> fine = file.check(); !fine) return fine.error();
  return s;
}

}  // namespace slosh
