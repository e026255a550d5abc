#include "peer/devices/gamepad_port.h"

#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <sstream>

#include "peer/devices/node_access.h"

namespace slosh {
namespace {

constexpr const char* kClass = "/sys/class/input";
constexpr const char* kNode = "event";
constexpr int kMaxEvents = 512;  // at once: a device that never stops must not keep the thread
constexpr std::array<unsigned, 13> kButtons{BTN_SOUTH, BTN_EAST,   BTN_NORTH, BTN_WEST,   BTN_TL,
                                            BTN_TR,    BTN_TL2,    BTN_TR2,   BTN_SELECT, BTN_START,
                                            BTN_MODE,  BTN_THUMBL, BTN_THUMBR};

std::mutex& claims_mutex() {
  static std::mutex mutex;
  return mutex;
}
std::set<std::string>& gamepad_claims() {
  static std::set<std::string> all;
  return all;
}

std::string first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// Whether bit `number` is in the kernel's words, the highest first.
bool has_bit(const std::string& words, unsigned number) {
  std::istringstream in(words);
  std::vector<std::string> all;
  for (std::string word; in >> word;) all.push_back(word);
  constexpr unsigned kBits = 8 * sizeof(unsigned long);
  const std::size_t back = number / kBits;
  if (back >= all.size()) return false;
  const unsigned long word = std::strtoul(all[all.size() - 1 - back].c_str(), nullptr, 16);
  return (word >> (number % kBits) & 1u) != 0;
}

/// −1 to 1 over the axis' range, 0 in the middle; 0 where there is none.
double centred(const libevdev* device, unsigned axis) {
  const input_absinfo* const info = libevdev_get_abs_info(device, axis);
  if (info == nullptr || info->maximum <= info->minimum) return 0.0;
  const double middle = 0.5 * (static_cast<double>(info->maximum) + info->minimum);
  const double half = 0.5 * (static_cast<double>(info->maximum) - info->minimum);
  const double off = info->value - middle;
  if (std::abs(off) <= info->flat) return 0.0;
  return std::clamp(off / half, -1.0, 1.0);
}

/// 0 to 1 over the axis' range; 0 where there is none.
double pressed(const libevdev* device, unsigned axis) {
  const input_absinfo* const info = libevdev_get_abs_info(device, axis);
  if (info == nullptr || info->maximum <= info->minimum) return 0.0;
  return std::clamp((static_cast<double>(info->value) - info->minimum) /
                        (static_cast<double>(info->maximum) - info->minimum),
                    0.0, 1.0);
}

}  // namespace

std::vector<GamepadFound> find_gamepads() {
  std::vector<GamepadFound> found;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(kClass, none)) {
    const std::string node = entry.path().filename().string();
    if (node.rfind(kNode, 0) != 0) continue;
    // The device that the node is a part of: its parent, wherever the class' link leads.
    const std::filesystem::path device = entry.path() / "..";
    const std::string axes = first_line(device / "capabilities" / "abs");
    if (!has_bit(first_line(device / "capabilities" / "key"), BTN_GAMEPAD) || !has_bit(axes, ABS_X) ||
        !has_bit(axes, ABS_Y))
      continue;
    found.push_back({"/dev/input/" + node, first_line(device / "name"), first_line(device / "uniq")});
  }
  std::sort(found.begin(), found.end(), [](const GamepadFound& a, const GamepadFound& b) {
    return a.path.size() != b.path.size() ? a.path.size() < b.path.size() : a.path < b.path;
  });
  return found;
}

bool GamepadPort::claimed(const std::string& path) {
  const std::lock_guard lock(claims_mutex());
  return gamepad_claims().count(path) > 0;
}

GamepadPort::GamepadPort(int node, libevdev* device, std::string path)
    : node_(node), device_(device), path_(std::move(path)) {}

GamepadPort::GamepadPort(GamepadPort&& other) noexcept
    : node_(other.node_), device_(other.device_), path_(std::move(other.path_)) {
  other.node_ = -1;
  other.device_ = nullptr;
  other.path_.clear();
}

GamepadPort::~GamepadPort() {
  if (node_ < 0) return;  // moved from: open() still holds the claims then
  libevdev_free(device_);
  ::close(node_);
  const std::lock_guard lock(claims_mutex());
  gamepad_claims().erase(path_);
}

Result<GamepadPort> GamepadPort::open(const std::string& path) {
  const Result<bool> may = check_node_access(path, R_OK);
  if (!may) return may.error();
  const std::lock_guard lock(claims_mutex());
  if (gamepad_claims().count(path) > 0)
    return Error{path, "another hand has it already", "Give each hand its own device, or none by name"};
  const int node = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (node < 0) return Error{path, std::strerror(errno), "Plug the device in again"};
  libevdev* device = nullptr;
  const int code = libevdev_new_from_fd(node, &device);
  if (code < 0) {
    ::close(node);
    return Error{path, std::string("it does not answer as an input device: ") + std::strerror(-code),
                 "Plug the device in again"};
  }
  if (!libevdev_has_event_code(device, EV_KEY, BTN_GAMEPAD)) {
    libevdev_free(device);
    ::close(node);
    return Error{path, "it is no gamepad", "`./slosh devices` lists those that are"};
  }
  gamepad_claims().insert(path);
  return GamepadPort(node, device, path);
}

bool GamepadPort::take(SpaceMouseState& state, std::uint64_t& events) {
  // Reading a node whose device went may end without an error: to libevdev that is nothing new.
  pollfd at{node_, POLLIN, 0};
  if (poll(&at, 1, 0) > 0 && (at.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0) return false;
  unsigned mode = LIBEVDEV_READ_FLAG_NORMAL;
  for (int i = 0; i < kMaxEvents; ++i) {
    input_event event{};
    const int code = libevdev_next_event(device_, mode, &event);
    if (code == -EAGAIN) {
      // What was dropped while nobody read is made up for; then it goes on as ever.
      if (mode == LIBEVDEV_READ_FLAG_NORMAL) break;
      mode = LIBEVDEV_READ_FLAG_NORMAL;
      continue;
    }
    if (code < 0) return false;
    if (code == LIBEVDEV_READ_STATUS_SYNC) mode = LIBEVDEV_READ_FLAG_SYNC;
    if (event.type == EV_ABS || event.type == EV_KEY) events += 1;
  }
  tell(state);
  return true;
}

void GamepadPort::tell(SpaceMouseState& state) const {
  const auto key = [this](unsigned code) { return libevdev_get_event_value(device_, EV_KEY, code) != 0; };
  const std::array<double, 6> along{centred(device_, ABS_X),
                                    centred(device_, ABS_Y),
                                    pressed(device_, ABS_RZ) - pressed(device_, ABS_Z),
                                    centred(device_, ABS_RY),
                                    centred(device_, ABS_RX),
                                    (key(BTN_TR) ? 1.0 : 0.0) - (key(BTN_TL) ? 1.0 : 0.0)};
  for (std::size_t i = 0; i < along.size(); ++i)
    state.axes[i] = static_cast<int>(std::lround(kSpaceMouseFull * along[i]));
  state.buttons = 0;
  for (std::size_t i = 0; i < kButtons.size(); ++i)
    if (key(kButtons[i])) state.buttons |= 1u << i;
}

}  // namespace slosh
