// Which USB devices are 3Dconnexion's with six axes, and which of its devices are something else.
#pragma once

#include <cstdint>

namespace slosh {

struct SpaceMouseModel {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  const char* name = "";
};

/// Null for anything that is not one, 3Dconnexion's keyboards and mice among them.
const SpaceMouseModel* spacemouse_model(std::uint16_t vendor, std::uint16_t product);

constexpr std::uint16_t kLogitechVendor = 0x046d;  ///< made the older ones
constexpr std::uint16_t k3DconnexionVendor = 0x256f;

}  // namespace slosh
