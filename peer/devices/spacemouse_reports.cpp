#include "peer/devices/spacemouse_reports.h"

#include <algorithm>

namespace slosh {
namespace {

constexpr std::uint8_t kTranslation = 0x01;
constexpr std::uint8_t kRotation = 0x02;
constexpr std::uint8_t kButtonMask = 0x03;
constexpr std::uint8_t kBatteryLevel = 0x17;
constexpr std::size_t kThreeAxes = 1 + 6;  // bytes with the number
constexpr std::size_t kSixAxes = 1 + 12;
constexpr int kFullBattery = 100;

int axis_at(const std::uint8_t* bytes) {
  const auto raw = static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[0] | (bytes[1] << 8)));
  return std::clamp<int>(raw, -kSpaceMouseFull, kSpaceMouseFull);
}

void take_axes(const std::uint8_t* bytes, std::size_t first, std::size_t count, SpaceMouseAxes& axes) {
  for (std::size_t i = 0; i < count; ++i) axes[first + i] = axis_at(bytes + 1 + 2 * i);
}

}  // namespace

SpaceMouseReport take_spacemouse_report(const std::uint8_t* bytes, std::size_t size, SpaceMouseState& state) {
  if (size == 0) return SpaceMouseReport::kMalformed;
  switch (bytes[0]) {
    case kTranslation:
      if (size < kThreeAxes) return SpaceMouseReport::kMalformed;
      if (size > kThreeAxes && size < kSixAxes) return SpaceMouseReport::kMalformed;
      take_axes(bytes, 0, size >= kSixAxes ? 6 : 3, state.axes);
      return SpaceMouseReport::kAxes;
    case kRotation:
      if (size < kThreeAxes) return SpaceMouseReport::kMalformed;
      take_axes(bytes, 3, 3, state.axes);
      return SpaceMouseReport::kAxes;
    case kButtonMask: {
      if (size < 2) return SpaceMouseReport::kMalformed;
      state.buttons = 0;
      for (std::size_t i = 1; i < std::min<std::size_t>(size, 5); ++i)
        state.buttons |= static_cast<std::uint32_t>(bytes[i]) << (8 * (i - 1));
      return SpaceMouseReport::kButtons;
    }
    case kBatteryLevel:
      if (size < 2 || bytes[1] > kFullBattery) return SpaceMouseReport::kMalformed;
      state.battery = bytes[1];
      return SpaceMouseReport::kBattery;
    default:
      return SpaceMouseReport::kUnknown;
  }
}

}  // namespace slosh
