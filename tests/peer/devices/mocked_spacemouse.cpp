#include "tests/peer/devices/mocked_spacemouse.h"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <umockdev.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <thread>

namespace slosh::test {
namespace {

std::string usb_path(int number) {
  return "/devices/pci0000:00/usb1/1-" + std::to_string(number);
}

/// hidapi asks a node for the size of its report descriptor to know a hidraw node.
gboolean mouse_answer(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer) {
  if (umockdev_ioctl_client_get_request(client) != HIDIOCGRDESCSIZE) return FALSE;
  UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
  GError* error = nullptr;
  UMockdevIoctlData* size = umockdev_ioctl_data_resolve(argument, 0, sizeof(int), &error);
  if (size == nullptr) return FALSE;
  int bytes = 6;
  umockdev_ioctl_data_update(size, 0, reinterpret_cast<guint8*>(&bytes), sizeof bytes);
  umockdev_ioctl_data_unref(size);
  umockdev_ioctl_client_complete(client, 0, 0);
  return TRUE;
}

void mouse_must(gboolean done, GError* error) {
  if (done) return;
  throw std::runtime_error(error != nullptr ? error->message : "umockdev would not");
}

}  // namespace

MockedMachine::MockedMachine() : testbed_(umockdev_testbed_new()) {}

MockedMachine::~MockedMachine() {
  g_object_unref(testbed_);
}

MockedSpaceMouse::MockedSpaceMouse(MockedMachine& machine, int number, std::uint16_t vendor,
                                   std::uint16_t product, const std::string& serial)
    : machine_(machine), number_(number) {
  char ids[2][16];
  char hid[40];
  std::snprintf(ids[0], sizeof ids[0], "%04x", vendor);
  std::snprintf(ids[1], sizeof ids[1], "%04x", product);
  std::snprintf(hid, sizeof hid, "0003:%04X:%04X.%04X", vendor, product, number);
  const std::string usb = usb_path(number);
  const std::string interface = usb + "/1-" + std::to_string(number) + ":1.0";
  hid_ = interface + "/" + hid;
  const std::string n = std::to_string(number);
  const std::string made =
      "P: " + usb + "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nA: idVendor=" + ids[0] +
      "\\n\nA: idProduct=" + ids[1] + "\\n\nA: serial=" + serial +
      "\\n\nA: manufacturer=3Dconnexion\\n\nA: product=Six Axes\\n\nA: bcdDevice=0437\\n\n\n" +
      "P: " + interface + "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\\n\n\n" +
      "P: " + hid_ + "\nE: SUBSYSTEM=hid\nE: HID_ID=0003:0000" + ids[0] + ":0000" + ids[1] +
      "\nE: HID_NAME=Six Axes\nE: HID_UNIQ=" + serial + "\nE: HID_PHYS=usb-" + n +
      "\nH: report_descriptor=05010908A101C0\n\n" + "P: " + hid_ + "/hidraw/hidraw" + n + "\nN: hidraw" + n +
      "\nE: SUBSYSTEM=hidraw\nE: DEVNAME=" + node() + "\nE: MAJOR=240\nE: MINOR=" + n + "\n\n";
  GError* error = nullptr;
  mouse_must(umockdev_testbed_add_from_string(machine.testbed(), made.c_str(), &error), error);
  UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
  g_signal_connect(handler, "handle-ioctl", G_CALLBACK(mouse_answer), nullptr);
  mouse_must(umockdev_testbed_attach_ioctl(machine.testbed(), node().c_str(), handler, &error), error);
  end_ = umockdev_testbed_get_dev_fd(machine.testbed(), node().c_str());
}

std::string MockedSpaceMouse::node() const {
  return "/dev/hidraw" + std::to_string(number_);
}

void MockedSpaceMouse::say(const std::vector<std::uint8_t>& report) {
  if (write(end_, report.data(), report.size()) != static_cast<ssize_t>(report.size()))
    throw std::runtime_error("the mocked device could not speak");
}

std::vector<std::uint8_t> MockedSpaceMouse::receive(std::size_t size) {
  std::vector<std::uint8_t> received(size);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = read(end_, received.data() + done, size - done);
    if (got < 0 && errno == EIO) {  // nobody has it open
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    if (got <= 0) throw std::runtime_error("the mocked device could not listen");
    done += static_cast<std::size_t>(got);
  }
  return received;
}

void MockedSpaceMouse::unplug() {
  // The other end of the terminal goes: reading fails, as of a hidraw node whose device went.
  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, end_);
  close(nothing);
  umockdev_testbed_detach_ioctl(machine_.testbed(), node().c_str(), nullptr);
  const std::string n = std::to_string(number_);
  const std::string usb = usb_path(number_);
  for (const std::string& path : {hid_ + "/hidraw/hidraw" + n, hid_, usb + "/1-" + n + ":1.0", usb}) {
    umockdev_testbed_uevent(machine_.testbed(), ("/sys" + path).c_str(), "remove");
    umockdev_testbed_remove_device(machine_.testbed(), ("/sys" + path).c_str());
  }
}

}  // namespace slosh::test
