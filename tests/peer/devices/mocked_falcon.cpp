#include "tests/peer/devices/mocked_falcon.h"

#include <gtest/gtest.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <vector>

#include "peer/haptics/real_time.h"

namespace slosh::test {
namespace {

constexpr std::size_t kSetup = 8;  // bytes before what a control transfer carries
constexpr const char* kPath = "/devices/pci0000:00/usb1/1-4";
constexpr std::chrono::microseconds kFrame(1000);

gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer falcon) {
  return static_cast<MockedFalcon*>(falcon)->answer(client) ? TRUE : FALSE;
}

void must(gboolean done, GError* error) {
  if (done) return;
  throw std::runtime_error(error != nullptr ? error->message : "umockdev would not");
}

/// A string descriptor: the languages, or the serial number.
std::vector<guint8> string_of(guint8 index) {
  if (index == 0) return {4, 3, 0x09, 0x04};
  std::vector<guint8> bytes{0, 3};
  for (const char letter : std::string(kFalconSerial)) {
    bytes.push_back(static_cast<guint8>(letter));
    bytes.push_back(0);
  }
  bytes[0] = static_cast<guint8>(bytes.size());
  return bytes;
}

void wait_for_frame() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  std::this_thread::sleep_until(std::chrono::steady_clock::time_point(since / kFrame * kFrame + kFrame));
}

}  // namespace

MockedFalcon::MockedFalcon(MockedMachine& machine, FakeFalcon& falcon, int number, Pace pace)
    : machine_(machine), falcon_(falcon), link_(falcon), number_(number), pace_(pace) {
  char three[8];
  std::snprintf(three, sizeof three, "%03d", number);
  const std::string n = std::to_string(number);
  // Device descriptor, then one configuration with one interface and two bulk ends.
  const std::string made =
      std::string("P: ") + kPath + "\nN: bus/usb/001/" + three +
      "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DEVNAME=" + node() +
      "\nE: BUSNUM=001\nE: DEVNUM=" + three + "\nA: busnum=1\\n\nA: devnum=" + n +
      "\\n\nA: speed=12\\n\nA: bConfigurationValue=1\\n\nA: idVendor=0403\\n\nA: idProduct=cb48\\n\n"
      "H: descriptors="
      "1201000200000040030448cb0006010203010902200001010080320904000002ffffff00070502024000000705810240000000"
      "\n\n";
  GError* error = nullptr;
  must(umockdev_testbed_add_from_string(machine.testbed(), made.c_str(), &error), error);
  handler_ = umockdev_ioctl_base_new();
  g_signal_connect(handler_, "handle-ioctl", reinterpret_cast<GCallback>(+on_ioctl), this);
  must(umockdev_testbed_attach_ioctl(machine.testbed(), node().c_str(), handler_, &error), error);
}

MockedFalcon::~MockedFalcon() {
  umockdev_testbed_detach_ioctl(machine_.testbed(), node().c_str(), nullptr);
  g_object_unref(handler_);
}

std::string MockedFalcon::node() const {
  char text[40];
  std::snprintf(text, sizeof text, "/dev/bus/usb/001/%03d", number_);
  return text;
}

void MockedFalcon::unplug() {
  with([](FakeFalcon& falcon) { falcon.gone = true; });
  const std::string path = std::string("/sys") + kPath;
  umockdev_testbed_uevent(machine_.testbed(), path.c_str(), "remove");
  umockdev_testbed_remove_device(machine_.testbed(), path.c_str());
}

bool MockedFalcon::answer(UMockdevIoctlClient* client) {
  // Hardware waits for no other program: where the kernel grants it, neither does what stands for it.
  if (pace_ == Pace::kFrames) {
    thread_local const bool first = (become_device_thread("falcon"), true);
    (void)first;
  }
  switch (umockdev_ioctl_client_get_request(client)) {
    case USBDEVFS_GET_CAPABILITIES: {
      GError* error = nullptr;
      UMockdevIoctlData* caps = umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0,
                                                            sizeof(std::uint32_t), &error);
      std::uint32_t none = 0;
      umockdev_ioctl_data_update(caps, 0, reinterpret_cast<guint8*>(&none), sizeof none);
      umockdev_ioctl_data_unref(caps);
      umockdev_ioctl_client_complete(client, 0, 0);
      return true;
    }
    case USBDEVFS_IOCTL:  // the kernel's own driver comes back
    case USBDEVFS_DISCONNECT_CLAIM:
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RELEASEINTERFACE:
      umockdev_ioctl_client_complete(client, 0, 0);
      return true;
    case USBDEVFS_GETDRIVER:
      umockdev_ioctl_client_complete(client, -1, ENODATA);
      return true;
    case USBDEVFS_SUBMITURB:
      return submit(client);
    case USBDEVFS_REAPURBNDELAY:
    case USBDEVFS_REAPURB:
      return reap(client);
    case USBDEVFS_DISCARDURB:
      umockdev_ioctl_client_complete(client, -1, EINVAL);
      return true;
    default:
      return false;
  }
}

bool MockedFalcon::submit(UMockdevIoctlClient* client) {
  const std::lock_guard lock(mutex_);
  if (falcon_.gone) {
    umockdev_ioctl_client_complete(client, -1, ENODEV);
    return true;
  }
  GError* error = nullptr;
  UMockdevIoctlData* request =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(usbdevfs_urb), &error);
  usbdevfs_urb urb{};
  std::memcpy(&urb, request->data, sizeof urb);
  UMockdevIoctlData* buffer = umockdev_ioctl_data_resolve(request, offsetof(usbdevfs_urb, buffer),
                                                          static_cast<gsize>(urb.buffer_length), &error);
  int length = 0;
  bool in = false;
  if (urb.type == USBDEVFS_URB_TYPE_CONTROL) {
    const guint8* s = buffer->data;
    if (s[0] == 0x80 && s[1] == 6 && s[3] == 3) {
      std::vector<guint8> text = string_of(s[2]);
      length = std::min(static_cast<int>(text.size()), static_cast<int>(urb.buffer_length - kSetup));
      umockdev_ioctl_data_update(buffer, kSetup, text.data(), length);
    } else {
      EXPECT_EQ(s[0], 0x40);
      EXPECT_EQ(s[4] | s[5] << 8, 0) << "index";
      EXPECT_EQ(static_cast<std::size_t>(urb.buffer_length), kSetup);
      link_.control(s[1], static_cast<std::uint16_t>(s[2] | s[3] << 8));
    }
  } else if (urb.endpoint == 0x02) {
    link_.write(buffer->data, static_cast<std::size_t>(urb.buffer_length), 0);
    length = urb.buffer_length;
  } else {
    EXPECT_EQ(urb.endpoint, 0x81);
    std::array<guint8, 64> packet{0x31, 0x60};  // the modem bytes
    length = 2 + link_.read(packet.data() + 2, 62, 0);
    umockdev_ioctl_data_update(buffer, 0, packet.data(), static_cast<gsize>(length));
    in = true;
  }
  umockdev_ioctl_data_unref(buffer);
  urb.status = 0;
  urb.actual_length = length;
  umockdev_ioctl_data_update(request, offsetof(usbdevfs_urb, status), reinterpret_cast<guint8*>(&urb.status),
                             sizeof urb.status);
  umockdev_ioctl_data_update(request, offsetof(usbdevfs_urb, actual_length),
                             reinterpret_cast<guint8*>(&urb.actual_length), sizeof urb.actual_length);
  done_.push_back({request, in});
  umockdev_ioctl_client_complete(client, 0, 0);
  return true;
}

bool MockedFalcon::reap(UMockdevIoctlClient* client) {
  if (done_.empty()) {
    umockdev_ioctl_client_complete(client, -1, with([](FakeFalcon& f) { return f.gone; }) ? ENODEV : EAGAIN);
    return true;
  }
  const Transfer transfer = done_.front();
  if (transfer.in && pace_ == Pace::kFrames) wait_for_frame();
  GError* error = nullptr;
  UMockdevIoctlData* where =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(void*), &error);
  umockdev_ioctl_data_set_ptr(where, 0, transfer.request);
  umockdev_ioctl_data_unref(where);
  umockdev_ioctl_data_unref(transfer.request);
  done_.pop_front();
  umockdev_ioctl_client_complete(client, 0, 0);
  return true;
}

}  // namespace slosh::test
