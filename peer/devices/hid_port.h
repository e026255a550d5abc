// HID devices by hidapi: what is there, and one of them open.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/math/result.h"

struct hid_device_;

namespace slosh {

/// A HID device that is plugged in.
struct HidInfo {
  std::string path;  ///< "/dev/hidraw3"
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string serial;  ///< may be empty
  std::string name;    ///< what it calls itself; may be empty
};

/// All of them, in the order of their paths. Any thread.
std::vector<HidInfo> list_hid();

/// One open HID device, claimed: two hands of this process never share one. One thread but for claimed().
class HidPort {
 public:
  /// Errors: it is claimed, gone, or this user may not open it.
  static Result<HidPort> open(const std::string& path);
  static bool claimed(const std::string& path);
  HidPort(HidPort&& other) noexcept;
  HidPort& operator=(HidPort&&) = delete;
  ~HidPort();

  /// The next report with its number first, without waiting: its length, 0 when there is none, −1 when the
  /// device is gone.
  int read(std::uint8_t* bytes, std::size_t most);
  /// False when the device would not take it.
  bool write(const std::uint8_t* bytes, std::size_t size);

 private:
  HidPort(hid_device_* device, std::string path) : device_(device), path_(std::move(path)) {}
  hid_device_* device_;
  std::string path_;
};

}  // namespace slosh
