// The Falcon's driver, unmodified down to libusb, on a USB device that umockdev makes: transfers are the
// kernel's own requests, answered by the fake of the other tests.
#include "peer/haptics/devices/falcon_usb.h"

#include <gtest/gtest.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <deque>
#include <fstream>

#include "peer/haptics/devices/falcon_device.h"
#include "tests/peer/devices/fake_falcon.h"
#include "tests/peer/devices/falcon_node.h"
#include "tests/peer/devices/mocked_spacemouse.h"
#include "tests/peer/devices/own_folder.h"

namespace slosh {
namespace {

constexpr std::size_t kSetup = 8;  // bytes before what a control transfer carries

/// The kernel's side of the device's node. Called on umockdev's thread.
class UsbNode {
 public:
  explicit UsbNode(test::FakeFalcon& falcon) : link_(falcon) {}

  bool answer(UMockdevIoctlClient* client) {
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

 private:
  bool submit(UMockdevIoctlClient* client) {
    GError* error = nullptr;
    UMockdevIoctlData* request =
        umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(usbdevfs_urb), &error);
    usbdevfs_urb urb{};
    std::memcpy(&urb, request->data, sizeof urb);
    UMockdevIoctlData* buffer = umockdev_ioctl_data_resolve(request, offsetof(usbdevfs_urb, buffer),
                                                            static_cast<gsize>(urb.buffer_length), &error);
    int length = 0;
    if (urb.type == USBDEVFS_URB_TYPE_CONTROL) {
      const guint8* s = buffer->data;
      EXPECT_EQ(s[0], 0x40);
      EXPECT_EQ(s[4] | s[5] << 8, 0) << "index";
      EXPECT_EQ(static_cast<std::size_t>(urb.buffer_length), kSetup);
      link_.control(s[1], static_cast<std::uint16_t>(s[2] | s[3] << 8));
    } else if (urb.endpoint == 0x02) {
      link_.write(buffer->data, static_cast<std::size_t>(urb.buffer_length), 0);
      length = urb.buffer_length;
    } else {
      EXPECT_EQ(urb.endpoint, 0x81);
      std::array<guint8, 64> packet{0x31, 0x60};  // the modem bytes
      length = 2 + link_.read(packet.data() + 2, 62, 0);
      umockdev_ioctl_data_update(buffer, 0, packet.data(), static_cast<gsize>(length));
    }
    umockdev_ioctl_data_unref(buffer);
    urb.status = 0;
    urb.actual_length = length;
    umockdev_ioctl_data_update(request, offsetof(usbdevfs_urb, status),
                               reinterpret_cast<guint8*>(&urb.status), sizeof urb.status);
    umockdev_ioctl_data_update(request, offsetof(usbdevfs_urb, actual_length),
                               reinterpret_cast<guint8*>(&urb.actual_length), sizeof urb.actual_length);
    done_.push_back(request);
    umockdev_ioctl_client_complete(client, 0, 0);
    return true;
  }

  bool reap(UMockdevIoctlClient* client) {
    if (done_.empty()) {
      umockdev_ioctl_client_complete(client, -1, EAGAIN);
      return true;
    }
    GError* error = nullptr;
    UMockdevIoctlData* where =
        umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(void*), &error);
    umockdev_ioctl_data_set_ptr(where, 0, done_.front());
    umockdev_ioctl_data_unref(where);
    umockdev_ioctl_data_unref(done_.front());
    done_.pop_front();
    umockdev_ioctl_client_complete(client, 0, 0);
    return true;
  }

  test::FakeFalconLink link_;
  std::deque<UMockdevIoctlData*> done_;
};

gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer node) {
  return static_cast<UsbNode*>(node)->answer(client) ? TRUE : FALSE;
}

TEST(FalconUsb, FirmwareHomingAndThreeThousandReportsByLibusb) {
  test::OwnFolder folder;
  std::filesystem::create_directories(folder.path() / "slosh" / "devices");
  setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
  test::FakeFalcon falcon;
  for (int i = 0; i < 7357; ++i) falcon.firmware.push_back(static_cast<std::uint8_t>(i * 31 + i / 251));
  falcon.homed = false;
  std::ofstream(folder.path() / "firmware.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(falcon.firmware.data()), 7357);
  std::ofstream(folder.path() / "slosh" / "devices" / "falcon.conf")
      << "firmware = " << (folder.path() / "firmware.bin").string() << "\nscale = 1\nrelative_to = world\n";

  test::MockedMachine machine;
  GError* error = nullptr;
  ASSERT_TRUE(umockdev_testbed_add_from_string(machine.testbed(), test::kFalconNode, &error));
  UsbNode node(falcon);
  UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
  g_signal_connect(handler, "handle-ioctl", reinterpret_cast<GCallback>(+on_ioctl), &node);
  ASSERT_TRUE(umockdev_testbed_attach_ioctl(machine.testbed(), "/dev/bus/usb/001/004", handler, &error));

  FalconDevice device([] { return open_falcon(""); }, HandPlace{});
  const Result<bool> opened = open_device(device);
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_EQ(falcon.received, falcon.firmware);
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(device.read({}).heard);
    device.write({{3.0, 0.0, 0.0}, {}});
  }
  falcon.homed = true;
  std::size_t heard = 0;
  const std::size_t commands = falcon.commands.size();
  for (int i = 0; i < 3001; ++i) {
    if (device.read({}).heard) ++heard;
    device.write({{1.0, 0.0, 0.0}, {}});
  }
  EXPECT_GE(heard, 3000u) << "every reading but that of a packet from before it knew its place";
  EXPECT_EQ(falcon.commands.size() - commands, 3001u) << "one packet a reading";
  device.close();
  EXPECT_EQ(parse_falcon(falcon.commands.back())->counts, (std::array<int, 3>{0, 0, 0}));
}

}  // namespace
}  // namespace slosh
