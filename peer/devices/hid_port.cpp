#include "peer/devices/hid_port.h"

#include <hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <mutex>
#include <set>
#include <utility>

#include "peer/devices/node_access.h"

namespace slosh {
namespace {

/// hidapi keeps its last error and its start in globals: one caller at a time may list and open.
std::mutex& hid_mutex() {
  static std::mutex mutex;
  return mutex;
}
std::set<std::string>& claims() {
  static std::set<std::string> paths;
  return paths;
}

/// Of a wide string of hidapi's, what is plain ASCII: names of devices are shown in terminals.
std::string narrow(const wchar_t* wide) {
  std::string text;
  for (; wide != nullptr && *wide != L'\0'; ++wide)
    text += *wide >= L' ' && *wide < 0x7f ? static_cast<char>(*wide) : '?';
  return text;
}

}  // namespace

std::vector<HidInfo> list_hid() {
  const std::lock_guard lock(hid_mutex());
  std::vector<HidInfo> found;
  hid_device_info* const list = hid_enumerate(0, 0);
  for (const hid_device_info* each = list; each != nullptr; each = each->next) {
    HidInfo info{each->path, each->vendor_id, each->product_id, narrow(each->serial_number),
                 narrow(each->product_string)};
    // One entry for each usage of a node.
    const bool known = std::any_of(found.begin(), found.end(),
                                   [&](const HidInfo& other) { return other.path == info.path; });
    if (!known) found.push_back(std::move(info));
  }
  hid_free_enumeration(list);
  std::sort(found.begin(), found.end(), [](const HidInfo& a, const HidInfo& b) {
    return a.path.size() != b.path.size() ? a.path.size() < b.path.size() : a.path < b.path;
  });
  return found;
}

bool HidPort::claimed(const std::string& path) {
  const std::lock_guard lock(hid_mutex());
  return claims().count(path) > 0;
}

Result<HidPort> HidPort::open(const std::string& path) {
  const Result<bool> may = check_node_access(path, R_OK | W_OK);
  if (!may) return may.error();
  const std::lock_guard lock(hid_mutex());
  if (claims().count(path) > 0) {
    return Error{path, "another hand has it already", "Give each hand its own device, or none by name"};
  }
  hid_device* const device = hid_open_path(path.c_str());
  if (device == nullptr)
    return Error{path, "cannot be opened: " + narrow(hid_error(nullptr)), "Plug the device in again"};
  hid_set_nonblocking(device, 1);
  claims().insert(path);
  return HidPort(device, path);
}

HidPort::HidPort(HidPort&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)), path_(std::move(other.path_)) {}

HidPort::~HidPort() {
  if (device_ == nullptr) return;
  const std::lock_guard lock(hid_mutex());
  hid_close(device_);
  claims().erase(path_);
}

int HidPort::read(std::uint8_t* bytes, std::size_t most) {
  return hid_read(device_, bytes, most);
}

bool HidPort::write(const std::uint8_t* bytes, std::size_t size) {
  return hid_write(device_, bytes, size) == static_cast<int>(size);
}

}  // namespace slosh
