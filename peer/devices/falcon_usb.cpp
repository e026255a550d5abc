#include "peer/devices/falcon_usb.h"

#include <libusb.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace slosh {
namespace {

constexpr int kInterface = 0;
constexpr std::uint8_t kOut = 0x02, kIn = 0x81;
constexpr std::uint8_t kVendorRequest = 0x40;
constexpr unsigned kControlPatience = 5000;  // ms
constexpr int kModemBytes = 2;               // before what an IN packet brings
constexpr int kInPacket = 64;

struct Context {
  libusb_context* usb = nullptr;
  Context() { (void)libusb_init(&usb); }
  ~Context() {
    if (usb != nullptr) libusb_exit(usb);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
};

std::string path_of(libusb_device* device) {
  std::array<std::uint8_t, 8> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string path = "usb " + std::to_string(libusb_get_bus_number(device));
  for (int i = 0; i < count; ++i) {
    path += i == 0 ? "-" : ".";
    path += std::to_string(ports[static_cast<std::size_t>(i)]);
  }
  return path;
}

std::string node_of(libusb_device* device) {
  char node[40];
  std::snprintf(node, sizeof node, "/dev/bus/usb/%03d/%03d", libusb_get_bus_number(device),
                libusb_get_device_address(device));
  return node;
}

std::string serial_of(libusb_device_handle* handle, std::uint8_t index) {
  std::array<unsigned char, 128> text{};
  if (index == 0 || libusb_get_string_descriptor_ascii(handle, index, text.data(), text.size()) <= 0)
    return {};
  return reinterpret_cast<const char*>(text.data());
}

class UsbLink final : public FalconLink {
 public:
  UsbLink(std::shared_ptr<Context> context, libusb_device_handle* handle, std::string where)
      : context_(std::move(context)), handle_(handle), where_(std::move(where)) {}
  ~UsbLink() override {
    libusb_release_interface(handle_, kInterface);
    libusb_close(handle_);
  }
  bool control(std::uint8_t request, std::uint16_t value) override {
    return libusb_control_transfer(handle_, kVendorRequest, request, value, 0, nullptr, 0,
                                   kControlPatience) >= 0;
  }
  bool write(const std::uint8_t* bytes, std::size_t size, int most_ms) override {
    int went = 0;
    const int code = libusb_bulk_transfer(handle_, kOut, const_cast<std::uint8_t*>(bytes),
                                          static_cast<int>(size), &went, static_cast<unsigned>(most_ms));
    // What went before its time was over has gone.
    return (code == 0 || code == LIBUSB_ERROR_TIMEOUT) && went == static_cast<int>(size);
  }
  int read(std::uint8_t* bytes, std::size_t most, int most_ms) override {
    // What one IN packet brought beyond what was asked for waits here.
    for (int waited = 0; begin_ == end_ && waited <= most_ms; ++waited) {
      int got = 0;
      // The chip answers each latency time, with its modem bytes alone where there is nothing.
      const int code = libusb_bulk_transfer(handle_, kIn, packet_.data(), kInPacket, &got,
                                            static_cast<unsigned>(std::max(most_ms, 1)));
      if (code != 0 && code != LIBUSB_ERROR_TIMEOUT) return -1;
      if (got == 0) return 0;  // a packet that came as its time ended counts
      begin_ = std::min(kModemBytes, got);
      end_ = got;
    }
    const int take = std::min(end_ - begin_, static_cast<int>(most));
    std::copy_n(packet_.begin() + begin_, take, bytes);
    begin_ += take;
    return take;
  }
  std::string where() const override { return where_; }

 private:
  std::shared_ptr<Context> context_;
  libusb_device_handle* handle_;
  const std::string where_;
  std::array<std::uint8_t, kInPacket> packet_{};
  int begin_ = 0;
  int end_ = 0;
};

/// Calls `each` with every Falcon until it says true.
template <class Each>
void visit(Context& context, Each&& each) {
  if (context.usb == nullptr) return;
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context.usb, &list);
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor about{};
    if (libusb_get_device_descriptor(list[i], &about) != 0) continue;
    if (about.idVendor != kFalconVendor || about.idProduct != kFalconProduct) continue;
    if (each(list[i], about)) break;
  }
  if (list != nullptr) libusb_free_device_list(list, 1);
}

}  // namespace

std::vector<FalconFound> find_falcons() {
  Context context;
  std::vector<FalconFound> all;
  visit(context, [&](libusb_device* device, const libusb_device_descriptor& about) {
    FalconFound found{path_of(device), node_of(device), {}};
    libusb_device_handle* handle = nullptr;
    if (libusb_open(device, &handle) == 0) {
      found.serial = serial_of(handle, about.iSerialNumber);
      libusb_close(handle);
    }
    all.push_back(std::move(found));
    return false;
  });
  return all;
}

Result<std::unique_ptr<FalconLink>> open_falcon(const std::string& which) {
  auto context = std::make_shared<Context>();
  std::unique_ptr<FalconLink> link;
  Error why{"--device falcon",
            which.empty() ? "no Falcon is there" : "no Falcon of that number or path is there",
            "Plug in its USB cable and its power; `./slosh devices` lists what is there"};
  visit(*context, [&](libusb_device* device, const libusb_device_descriptor& about) {
    libusb_device_handle* handle = nullptr;
    const int code = libusb_open(device, &handle);
    if (code != 0) {
      why = {node_of(device), std::string("cannot be opened: ") + libusb_strerror(code),
             code == LIBUSB_ERROR_ACCESS
                 ? "Install the udev rule once (`./slosh devices --install-udev-rule`) "
                   "and plug it in again"
                 : "Plug it in again"};
      return false;
    }
    const bool wanted =
        which.empty() || which == path_of(device) || which == serial_of(handle, about.iSerialNumber);
    if (wanted) {
      (void)libusb_set_auto_detach_kernel_driver(handle, 1);  // ftdi_sio takes every chip of FTDI's
      if (libusb_claim_interface(handle, kInterface) == 0) {
        link = std::make_unique<UsbLink>(context, handle,
                                         "Falcon (" + path_of(device) + ", " + node_of(device) + ")");
        return true;
      }
      why = {node_of(device), "another program or hand has it", "End that program"};
    }
    libusb_close(handle);
    return false;
  });
  if (!link) return why;
  return link;
}

}  // namespace slosh
