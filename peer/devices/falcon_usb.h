// The Falcon's USB chip by libusb.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "peer/devices/falcon_protocol.h"

namespace slosh {

constexpr std::uint16_t kFalconVendor = 0x0403;
constexpr std::uint16_t kFalconProduct = 0xcb48;

struct FalconFound {
  std::string path;    ///< "usb 1-4", bus and port
  std::string node;    ///< "/dev/bus/usb/001/005"
  std::string serial;  ///< empty where this user may not ask
};
std::vector<FalconFound> find_falcons();

/// The first that no other hand has, or the one of this serial number or path. Errors: none is there, this
/// user may not open it, another program has it.
Result<std::unique_ptr<FalconLink>> open_falcon(const std::string& which);

}  // namespace slosh
