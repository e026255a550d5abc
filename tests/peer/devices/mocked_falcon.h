// A Falcon that umockdev makes: a USB device whose transfers are the kernel's own requests, answered by the
// fake of the other tests.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

#include "tests/peer/devices/fake_falcon.h"
#include "tests/peer/devices/mocked_spacemouse.h"

struct _UMockdevIoctlBase;
struct _UMockdevIoctlClient;
struct _UMockdevIoctlData;

namespace slosh::test {

constexpr const char* kFalconSerial = "F1234";

/// Plugged in until unplug() or the end. `number`: of its node, another at each plugging in, as the kernel
/// counts. `falcon` is used on umockdev's thread: look at it by with() once a driver runs.
class MockedFalcon {
 public:
  /// When what is asked for comes: at once, or with the frames of a full-speed bus, one a millisecond of the
  /// clock on the wall.
  enum class Pace { kAtOnce, kFrames };
  MockedFalcon(MockedMachine& machine, FakeFalcon& falcon, int number, Pace pace = Pace::kAtOnce);
  ~MockedFalcon();
  MockedFalcon(const MockedFalcon&) = delete;
  MockedFalcon& operator=(const MockedFalcon&) = delete;

  /// Every transfer fails from now on, and the node goes.
  void unplug();
  std::string node() const;
  template <class Do>
  auto with(Do&& act) {
    const std::lock_guard lock(mutex_);
    return act(falcon_);
  }

  /// One request of the kernel's interface; false where it is none of those that libusb makes.
  bool answer(_UMockdevIoctlClient* client);

 private:
  bool submit(_UMockdevIoctlClient* client);
  bool reap(_UMockdevIoctlClient* client);

  MockedMachine& machine_;
  FakeFalcon& falcon_;
  FakeFalconLink link_;
  const int number_;
  const Pace pace_;
  std::mutex mutex_;
  struct Transfer {
    _UMockdevIoctlData* request;
    bool in;
  };
  std::deque<Transfer> done_;
  _UMockdevIoctlBase* handler_ = nullptr;
};

}  // namespace slosh::test
