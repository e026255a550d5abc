#include "peer/devices/hardware.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "peer/devices/falcon_device.h"
#include "peer/devices/falcon_usb.h"
#include "peer/devices/gamepad_device.h"
#include "peer/devices/node_access.h"
#include "peer/devices/operator_device.h"
#include "peer/devices/plugin_device.h"
#include "peer/devices/plugin_library.h"
#include "peer/devices/spacemouse_device.h"

namespace slosh {
namespace {

using Made = Result<std::unique_ptr<Device>>;

Made make_operator(const std::string& options, const HandPlace& place) {
  const Result<OperatorSettings> settings = parse_operator(options);
  if (!settings) return settings.error();
  return Made(std::make_unique<OperatorDevice>(PoseTrack(place.motion, place.start), settings.value()));
}

// Now, and not when all is measured and settled. Loading runs what is in a library, so it is fenced; what
// does not end is said when the device is opened.
std::optional<Error> why_not_loaded(const std::string& file) {
  constexpr double kPatience = 1.0;  // s
  const auto refused = std::make_shared<std::optional<Error>>();
  const std::string did = fenced(kPatience, [refused, file] {
    if (const Result<PluginLibrary> library = load_plugin(file); !library) *refused = library.error();
  });
  return did.empty() ? *refused : std::nullopt;
}

Made make_plugin(const std::string& rest, const HandPlace& place) {
  const std::size_t colon = rest.find(':');
  const std::string file = rest.substr(0, colon);
  if (file.empty())
    return Error{"--device plugin", "no library is named", "Give --device plugin:FILE[:OPTIONS]"};
  if (const std::optional<Error> error = why_not_loaded(file)) return *error;
  const std::string options = colon == std::string::npos ? "" : rest.substr(colon + 1);
  return Made(std::make_unique<PluginDevice>(file, options, place));
}

/// The plug-in for trackers lies beside the program as it was built or installed.
Made make_tracker(const std::string& options, const HandPlace& place) {
  constexpr const char* kLibrary = "slosh_osc_device.so";
  std::error_code code;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", code).parent_path();
  for (const char* folder : {"../lib", "../lib/slosh"}) {
    const std::filesystem::path file = (program / folder / kLibrary).lexically_normal();
    if (std::filesystem::exists(file, code))
      return Made(std::make_unique<PluginDevice>(file.string(), options, place));
  }
  return Error{"--device osc",
               std::string("its plug-in ") + kLibrary + " does not lie in ../lib or ../lib/slosh of " +
                   program.string(),
               "Give --device plugin:FILE[:OPTIONS] with the path where it is"};
}

void note_access(FoundDevice& device, const std::string& node, int wanted) {
  const Result<bool> may = check_node_access(node, wanted);
  if (may) return;
  device.problem = may.error().what;
  device.mend = may.error().mend;
  device.denied = node_denied(node, wanted);
}

std::string hex(std::uint16_t number) {
  char text[8];
  std::snprintf(text, sizeof text, "%04x", number);
  return text;
}

}  // namespace

glm::dquat camera_axes(const glm::dvec3& eye, const glm::dvec3& target) {
  const glm::dvec3 back = eye - target;
  const glm::dvec3 right = glm::cross(glm::dvec3(0.0, 1.0, 0.0), back);
  if (glm::length(right) < 1e-9) return {1.0, 0.0, 0.0, 0.0};  // straight up or down
  const glm::dvec3 x = glm::normalize(right);
  const glm::dvec3 z = glm::normalize(back);
  return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

std::optional<Made> make_hardware(const std::string& spec, const HandPlace& place) {
  const std::size_t colon = spec.find(':');
  const std::string kind = spec.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : spec.substr(colon + 1);
  if (kind == "spacemouse") return Made(std::make_unique<SpaceMouseDevice>(rest, place.start, place.camera));
  if (kind == "gamepad") return Made(std::make_unique<GamepadDevice>(rest, place.start, place.camera));
  if (kind == "falcon") {
    return Made(std::make_unique<FalconDevice>([rest] { return open_falcon(rest); }, place));
  }
  if (kind == "plugin") return make_plugin(rest, place);
  if (kind == "osc") return make_tracker(rest, place);
  if (kind == "operator") return make_operator(rest, place);
  return std::nullopt;
}

bool is_tied(const std::string& spec) {
  const std::string kind = spec.substr(0, spec.find(':'));
  return kind == "falcon" || kind == "plugin";
}

std::vector<FoundDevice> find_hardware() {
  std::vector<FoundDevice> all;
  for (const SpaceMouseFound& found : find_spacemice()) {
    FoundDevice device;
    device.name = found.model->name;
    device.where = found.hid.path;
    if (!found.hid.serial.empty()) device.where += ", serial " + found.hid.serial;
    device.spec = "spacemouse:" + (found.hid.serial.empty() ? found.hid.path : found.hid.serial);
    note_access(device, found.hid.path, R_OK | W_OK);
    all.push_back(std::move(device));
  }
  for (const GamepadFound& found : find_gamepads()) {
    FoundDevice device;
    device.name = found.name.empty() ? "gamepad" : found.name;
    device.where = found.path;
    if (!found.serial.empty()) device.where += ", serial " + found.serial;
    device.spec = "gamepad:" + (found.serial.empty() ? found.path : found.serial);
    note_access(device, found.path, R_OK);
    all.push_back(std::move(device));
  }
  for (const FalconFound& found : find_falcons()) {
    FoundDevice device;
    device.name = "Novint Falcon";
    device.where = found.path + ", " + found.node;
    device.spec = "falcon:" + (found.serial.empty() ? found.path : found.serial);
    note_access(device, found.node, R_OK | W_OK);
    all.push_back(std::move(device));
  }
  return all;
}

std::string udev_rule() {
  std::string rule = "# Haptic and six-axis devices for slosh: whoever sits at this machine may open them.\n";
  for (const std::uint16_t vendor : {kLogitechVendor, k3DconnexionVendor}) {
    // Logitech makes keyboards too: only its models with six axes, all of 3Dconnexion's.
    const std::string product = vendor == kLogitechVendor ? "c6*" : "*";
    rule += "KERNEL==\"hidraw*\", ATTRS{idVendor}==\"" + hex(vendor) + "\", ATTRS{idProduct}==\"" + product +
            "\", TAG+=\"uaccess\"\n";
  }
  rule += "KERNEL==\"event*\", SUBSYSTEM==\"input\", ENV{ID_INPUT_JOYSTICK}==\"1\", TAG+=\"uaccess\"\n";
  rule += "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"" + hex(kFalconVendor) + "\", ATTR{idProduct}==\"" +
          hex(kFalconProduct) + "\", TAG+=\"uaccess\"\n";
  return rule;
}

}  // namespace slosh
