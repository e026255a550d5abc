#include "peer/devices/falcon_device.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "peer/devices/room_tie.h"

namespace slosh {
namespace {

constexpr double kPeriod = 0.001;    // s
constexpr double kOwnDamping = 1.0;  // N·s/m, taken as such: nobody states it (README)
constexpr std::size_t kMinFirmware = 4096, kMaxFirmware = 65536;  // bytes; those known have 7.3 to 8.5 kB
constexpr int kReadPatience = 5;                                  // ms
constexpr int kWritePatience = 50;                                // ms
constexpr double kAskAgain = 0.02;            // s without an answer after which it is asked again
constexpr double kGone = 2.0;                 // s without one after which it is given up
constexpr double kMotorPerTorque = -10000.0;  // of its units, a N·m
constexpr int kMaxMotor = 4096;
constexpr int kCentreButton = 3;

DeviceLimits sheet() {
  DeviceLimits l;
  l.max_force = 8.0;
  l.max_force_rate = 2000.0;
  l.max_stiffness = 3000.0;
  l.max_damping = 20.0;
  l.workspace_radius = 0.04;
  // It does not turn: what it is sent of torques it passes over.
  l.max_torque = 0.1;
  l.max_torque_rate = 10.0;
  l.max_rotational_stiffness = 1.0;
  l.max_rotational_damping = 0.01;
  return l;
}

}  // namespace

FalconDevice::FalconDevice(OpenLink open_link, HandPlace place, Clock now_ns)
    : open_link_(std::move(open_link)), place_(std::move(place)), now_ns_(std::move(now_ns)) {}

FalconDevice::~FalconDevice() {
  FalconDevice::close();
}

Result<bool> FalconDevice::open() {
  Result<std::unique_ptr<FalconLink>> link = open_link_();
  if (!link) return link.error();
  link_ = std::move(link.value());
  const std::filesystem::path path = device_settings_file("falcon", "");
  Result<DeviceFile> file = DeviceFile::read(path);
  if (!file) return file.error();
  HandMapSettings defaults;
  defaults.scale = 3.0;
  defaults.clutch_button = kCentreButton;
  HandMapSettings settings = read_hand_map(file.value(), defaults);
  firmware_ = file.value().text("firmware");
  if (const Result<bool> fine = file.value().check(); !fine) return fine;
  if (place_.tie) {
    if (const Result<bool> begun = place_.tie->begin("falcon"); !begun) return begun;
    if (place_.tie->shared()) tie_to_room(settings, place_.tie->scale());
  }
  ChosenGains gains = choose_gains(sheet(), kOwnDamping, 1.0, kPeriod, settings, "falcon");
  warnings_ = std::move(gains.warnings);
  map_.emplace(settings, place_);
  limits_ = map_->to_world(gains.limits);
  return bring_up();
}

Result<bool> FalconDevice::bring_up() {
  if (!begin_falcon_packets(*link_) || !answers()) {
    if (!firmware_) {
      return Error{
          device_settings_file("falcon", "").string(), "the Falcon has no firmware yet, and none is named",
          "Write `firmware = FILE` there, with the file of Novint's driver (it is theirs and not part "
          "of slosh; 7 to 9 kB, for example novint.bin)"};
    }
    if (const Result<bool> started = start(*firmware_); !started) return started;
  }
  received_ns_ = now_ns_();
  runs_ = true;
  answered_ = false;
  if (!send({0, 0, 0}))  // the first reading is its answer
    return Error{link_->where(), "it takes no packets", "Unplug it, plug it in and try again"};
  set_trouble("the Falcon does not know where it is yet: pull its grip out and push it in once");
  return true;
}

void FalconDevice::lose(const std::string& words) {
  link_.reset();
  runs_ = homed_ = placed_ = answered_ = false;
  looked_ns_ = now_ns_();
  velocity_.forget();
  set_trouble(words + " It goes on when it is back and its grip was pulled out and pushed in once");
}

void FalconDevice::look_again(std::int64_t now_ns) {
  if (to_seconds(now_ns - looked_ns_) < kLookAgain) return;
  looked_ns_ = now_ns;
  Result<std::unique_ptr<FalconLink>> link = open_link_();
  if (!link) return;
  link_ = std::move(link.value());
  const Result<bool> up = bring_up();
  if (!up) lose(up.error().where + ": " + up.error().what + ".");
}

Result<bool> FalconDevice::start(const std::filesystem::path& firmware) {
  std::ifstream in(firmware, std::ios::binary);
  std::vector<std::uint8_t> bytes(kMaxFirmware + 1);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (bytes.size() < kMinFirmware || bytes.size() > kMaxFirmware) {
    return Error{firmware.string(),
                 "is no firmware of a Falcon: " + std::to_string(bytes.size()) + " bytes could be read",
                 "Name the right file in falcon.conf"};
  }
  if (const Result<bool> sent = send_falcon_firmware(*link_, bytes); !sent) return sent;
  if (begin_falcon_packets(*link_) && answers()) return true;
  return Error{link_->where(), "it took the firmware and does not answer",
               "Is " + firmware.string() + " its firmware?"};
}

bool FalconDevice::answers() {
  std::array<std::uint8_t, 64> bytes{};
  stream_ = FalconStream{};
  if (!send({0, 0, 0})) return false;
  for (int i = 0; i < 20; ++i) {
    const int size = link_->read(bytes.data(), bytes.size(), kReadPatience);
    if (size < 0) return false;
    if (size > 0 && stream_.add(bytes.data(), static_cast<std::size_t>(size))) return true;
  }
  return false;
}

bool FalconDevice::send(const std::array<int, 3>& motors) {
  sent_ = motors;
  sent_ns_ = now_ns_();
  const std::uint8_t lights = homed_ ? kFalconGreen : kFalconRed;
  const FalconPacket packet = falcon_command(motors, static_cast<std::uint8_t>(lights | kFalconHoming));
  return link_->write(packet.data(), packet.size(), kWritePatience);
}

DeviceReport FalconDevice::silent() const {
  DeviceReport report;
  report.pose = place_.start;
  report.engaged = false;
  report.heard = false;
  return report;
}

std::optional<FalconState> FalconDevice::next_state() {
  std::array<std::uint8_t, 64> bytes{};
  // A packet may come in pieces.
  for (std::size_t i = 0; i < kFalconPacket; ++i) {
    const int size = link_->read(bytes.data(), bytes.size(), kReadPatience);
    if (size < 0) {
      lose("the Falcon is gone: is its cable out?");
      break;
    }
    if (size == 0) break;
    if (const auto state = stream_.add(bytes.data(), static_cast<std::size_t>(size))) return state;
  }
  return std::nullopt;
}

DeviceReport FalconDevice::read(const DeviceMoment&) {
  placed_ = false;
  if (!link_) look_again(now_ns_());
  if (!link_) return silent();
  const std::optional<FalconState> state = next_state();
  answered_ = state.has_value();
  const std::int64_t now_ns = now_ns_();
  if (!state) {
    const double silence = to_seconds(now_ns - received_ns_);
    if (link_ && silence > kGone) lose("the Falcon does not answer any more: has it power?");
    return silent();
  }
  received_ns_ = now_ns;
  if (state->homed != homed_) {
    homed_ = state->homed;
    velocity_.forget();
    set_trouble(homed_ ? "" : "the Falcon lost its place: pull its grip out and push it in once");
  }
  if (!homed_) return silent();
  const bool shared = place_.tie && place_.tie->shared();
  if (const glm::dquat* axes = camera_now_.news(); axes && !shared) map_->look_from(*axes);
  for (std::size_t i = 0; i < 3; ++i) angles_[i] = falcon_angle_of(state->counts[i]);
  const std::optional<glm::dvec3> grip = falcon_grip(angles_, grip_);
  if (!grip) return silent();
  grip_ = *grip;
  placed_ = true;
  DeviceReport report;
  report.pose.position = grip_ - glm::dvec3(0.0, 0.0, kFalconMiddle);
  report.twist = velocity_.add(report.pose, now_ns);
  report.buttons = state->buttons;
  const DeviceReport in_world = map_->to_world(report);
  if (place_.tie) {
    if (const auto axes = place_.tie->follow(report.pose, in_world.pose)) map_->look_from(*axes);
  }
  return in_world;
}

void FalconDevice::write(const Wrench& on_hand) {
  if (!link_) return;
  std::array<int, 3> motors{};
  if (homed_ && placed_) {
    const std::optional<glm::dvec3> torques = falcon_torques(grip_, angles_, map_->filtered(on_hand).force);
    if (torques) {
      glm::dvec3 values = kMotorPerTorque * *torques;
      // Together: the direction stays.
      const double most = std::max({std::abs(values.x), std::abs(values.y), std::abs(values.z)});
      if (most > kMaxMotor) values *= kMaxMotor / most;
      for (int i = 0; i < 3; ++i)
        motors[static_cast<std::size_t>(i)] = static_cast<int>(std::lround(values[i]));
    }
  }
  // One packet a reading, or answers would pile up; one that is lost is sent again after a while. A force
  // ends at once.
  const bool overdue = to_seconds(now_ns_() - sent_ns_) > kAskAgain;
  const bool ends = motors == std::array<int, 3>{} && sent_ != motors;
  if (!answered_ && !overdue && !ends) return;
  answered_ = false;
  if (!send(motors)) lose("the Falcon takes no force: is its cable out?");
}

void FalconDevice::close() {
  if (!link_) return;
  if (runs_) (void)send({0, 0, 0});
  runs_ = false;
  link_.reset();
}

void FalconDevice::set_trouble(const std::string& words) {
  const std::lock_guard lock(mutex_);
  trouble_ = words;
}

std::string FalconDevice::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

}  // namespace slosh
