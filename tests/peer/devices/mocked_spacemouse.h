// A SpaceMouse that umockdev makes: a USB device with a hidraw node, and what comes out of it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

struct _UMockdevTestbed;

namespace slosh::test {

/// The kernel as the drivers see it, empty at first. One at a time.
class MockedMachine {
 public:
  MockedMachine();
  ~MockedMachine();
  MockedMachine(const MockedMachine&) = delete;
  MockedMachine& operator=(const MockedMachine&) = delete;
  _UMockdevTestbed* testbed() const { return testbed_; }

 private:
  _UMockdevTestbed* testbed_;
};

/// Plugged in until unplug() or the end. `number`: of its node and its port, another for each.
class MockedSpaceMouse {
 public:
  MockedSpaceMouse(MockedMachine& machine, int number, std::uint16_t vendor, std::uint16_t product,
                   const std::string& serial);

  /// One report; a reader gets it whole only when it took the one before, as the node is a terminal beneath.
  void say(const std::vector<std::uint8_t>& report);
  /// What was written to it since, waiting for `size` bytes.
  std::vector<std::uint8_t> receive(std::size_t size);
  /// Reading fails from now on, and the node goes.
  void unplug();
  std::string node() const;

 private:
  MockedMachine& machine_;
  const int number_;
  std::string hid_;
  int end_ = -1;
};

}  // namespace slosh::test
