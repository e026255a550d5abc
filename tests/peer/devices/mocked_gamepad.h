// A gamepad that umockdev makes: a node under /dev/input, and what comes out of it.
#pragma once

#include <cstdint>
#include <string>

#include "tests/peer/devices/mocked_spacemouse.h"

namespace slosh::test {

/// Plugged in until unplug() or the end. Sticks from −32768 to 32767, triggers from 0 to 255.
class MockedGamepad {
 public:
  MockedGamepad(MockedMachine& machine, int number, const std::string& name, const std::string& serial = "");

  /// One event of the kernel's, and the report that ends it.
  void say(std::uint16_t type, std::uint16_t code, std::int32_t value);
  void unplug();
  std::string node() const { return "/dev/input/event" + std::to_string(number_); }

 private:
  MockedMachine& machine_;
  const int number_;
  std::string path_;
  std::string name_;
  int end_ = -1;
};

}  // namespace slosh::test
