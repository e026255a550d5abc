#include "tests/peer/devices/mocked_gamepad.h"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <umockdev.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>
#include <vector>

namespace slosh::test {
namespace {

constexpr unsigned kKeys[] = {BTN_SOUTH, BTN_EAST, BTN_NORTH,  BTN_WEST,
                              BTN_TL,    BTN_TR,   BTN_SELECT, BTN_START};
constexpr unsigned kSticks[] = {ABS_X, ABS_Y, ABS_RX, ABS_RY};
constexpr unsigned kTriggers[] = {ABS_Z, ABS_RZ};

void set_bit(std::vector<std::uint8_t>& bits, unsigned number) {
  if (number / 8 < bits.size()) bits[number / 8] |= static_cast<std::uint8_t>(1u << (number % 8));
}

/// What a driver of input devices says of itself.
std::vector<std::uint8_t> answer_of(unsigned number, std::size_t size, const char* name) {
  std::vector<std::uint8_t> bytes(size);
  const auto put = [&](const void* from, std::size_t count) {
    std::memcpy(bytes.data(), from, std::min(count, bytes.size()));
  };
  if (number == _IOC_NR(EVIOCGVERSION)) {
    const int version = EV_VERSION;
    put(&version, sizeof version);
  } else if (number == _IOC_NR(EVIOCGID)) {
    const input_id id{BUS_USB, 0x045e, 0x028e, 1};
    put(&id, sizeof id);
  } else if (number == _IOC_NR(EVIOCGNAME(0))) {
    put(name, std::strlen(name) + 1);
  } else if (number == _IOC_NR(EVIOCGBIT(0, 0))) {
    for (const unsigned type : {EV_SYN, EV_KEY, EV_ABS}) set_bit(bytes, type);
  } else if (number == _IOC_NR(EVIOCGBIT(EV_KEY, 0))) {
    for (const unsigned key : kKeys) set_bit(bytes, key);
  } else if (number == _IOC_NR(EVIOCGBIT(EV_ABS, 0))) {
    for (const unsigned axis : kSticks) set_bit(bytes, axis);
    for (const unsigned axis : kTriggers) set_bit(bytes, axis);
  } else if (number >= _IOC_NR(EVIOCGABS(0)) && number <= _IOC_NR(EVIOCGABS(ABS_MAX))) {
    input_absinfo info{};
    const unsigned axis = number - _IOC_NR(EVIOCGABS(0));
    const bool trigger = axis == ABS_Z || axis == ABS_RZ;
    info.minimum = trigger ? 0 : -32768;
    info.maximum = trigger ? 255 : 32767;
    info.flat = trigger ? 0 : 128;
    put(&info, sizeof info);
  }
  return bytes;
}

gboolean pad_answer(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer name) {
  const gulong request = umockdev_ioctl_client_get_request(client);
  if (_IOC_TYPE(request) != 'E') return FALSE;
  const std::size_t size = _IOC_SIZE(request);
  GError* error = nullptr;
  UMockdevIoctlData* const out =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, size, &error);
  if (out == nullptr) return FALSE;
  std::vector<std::uint8_t> bytes =
      answer_of(static_cast<unsigned>(_IOC_NR(request)), size, static_cast<const char*>(name));
  umockdev_ioctl_data_update(out, 0, bytes.data(), static_cast<gint>(bytes.size()));
  umockdev_ioctl_data_unref(out);
  umockdev_ioctl_client_complete(client, static_cast<glong>(size), 0);
  return TRUE;
}

void pad_must(gboolean done, GError* error) {
  if (done) return;
  throw std::runtime_error(error != nullptr ? error->message : "umockdev would not");
}

}  // namespace

MockedGamepad::MockedGamepad(MockedMachine& machine, int number, const std::string& name,
                             const std::string& serial)
    : machine_(machine), number_(number), name_(name) {
  const std::string n = std::to_string(number);
  path_ = "/devices/virtual/input/input" + n;
  // Words of the kernel's list, the highest first: BTN_SOUTH is bit 304, in the fifth of 64 bits.
  const std::string made =
      "P: " + path_ + "\nE: SUBSYSTEM=input\nA: name=" + name + "\\n\nA: uniq=" + serial +
      "\\n\nA: capabilities/key=cdb000000000000 0 0 0 0\\n\nA: capabilities/abs=3003f\\n\n\n" +
      "P: " + path_ + "/event" + n + "\nN: input/event" + n + "\nE: SUBSYSTEM=input\nE: DEVNAME=" + node() +
      "\nE: MAJOR=13\nE: MINOR=" + std::to_string(64 + number) + "\n\n";
  GError* error = nullptr;
  pad_must(umockdev_testbed_add_from_string(machine.testbed(), made.c_str(), &error), error);
  UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
  g_signal_connect(handler, "handle-ioctl", G_CALLBACK(pad_answer), name_.data());
  pad_must(umockdev_testbed_attach_ioctl(machine.testbed(), node().c_str(), handler, &error), error);
  end_ = umockdev_testbed_get_dev_fd(machine.testbed(), node().c_str());
}

void MockedGamepad::say(std::uint16_t type, std::uint16_t code, std::int32_t value) {
  input_event events[2]{};
  events[0].type = type;
  events[0].code = code;
  events[0].value = value;
  events[1].type = EV_SYN;
  if (write(end_, events, sizeof events) != static_cast<ssize_t>(sizeof events))
    throw std::runtime_error("the mocked device could not speak");
}

void MockedGamepad::unplug() {
  // The other end of the terminal goes: reading fails, as of a node whose device went.
  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, end_);
  close(nothing);
  umockdev_testbed_detach_ioctl(machine_.testbed(), node().c_str(), nullptr);
  for (const std::string& path : {path_ + "/event" + std::to_string(number_), path_}) {
    umockdev_testbed_uevent(machine_.testbed(), ("/sys" + path).c_str(), "remove");
    umockdev_testbed_remove_device(machine_.testbed(), ("/sys" + path).c_str());
  }
}

}  // namespace slosh::test
