// What a SpaceMouse says: HID input reports to deflections, buttons and battery.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace slosh {

/// Deflection of the cap as the device counts it: x y z rx ry rz, 350 at the stop.
using SpaceMouseAxes = std::array<int, 6>;

constexpr int kSpaceMouseFull = 350;  ///< counts at the stop, by its report descriptor

/// Everything that the device said so far.
struct SpaceMouseState {
  SpaceMouseAxes axes{};
  std::uint32_t buttons = 0;  ///< bit 0 is the first button
  int battery = -1;           ///< percent; −1: it did not say
};

enum class SpaceMouseReport : std::uint8_t { kAxes, kButtons, kBattery, kUnknown, kMalformed };

/// Takes one report in, as hidraw hands it over: its number first. Old devices tell translation (report 1)
/// and rotation (report 2) apart, newer ones both in report 1: told by its length. What is too short for
/// what its number says is malformed and changes nothing; a number that is not known changes nothing either
/// (keypads, displays and receivers have reports of their own). Counts beyond the stop are cut there.
SpaceMouseReport take_spacemouse_report(const std::uint8_t* bytes, std::size_t size, SpaceMouseState& state);

}  // namespace slosh
