// The verb `devices`: what is plugged in, what is wrong with it, what it says, and a slow push along its
// axes.
#include "peer/app/devices.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "net/text/clean.h"
#include "peer/app/common_options.h"
#include "peer/app/interrupt.h"
#include "peer/devices/device_file.h"
#include "peer/devices/hardware.h"
#include "render/headset.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr const char* kDevicesFooter =
    "Lists SpaceMice, gamepads and Falcons that are plugged in, each with what to give to --device, and what "
    "is wrong\n"
    "with it. Mostly that is a permission: then the rule that lets whoever sits at the machine open them is\n"
    "printed, with the command that puts it in place, and at a terminal it is asked whether to run that "
    "now;\n"
    "nothing is done, and sudo not started, without a yes. --install-udev-rule puts it in place without a\n"
    "question (needs root).\n"
    "\n"
    "--live shows what devices say, ten times a second, until Ctrl-C: hold it, move every axis, press every\n"
    "button. `slosh devices test NAME` pushes slowly along each axis and tells stiffness and damping of "
    "what\n"
    "holds the handle, and how even the device's loop is. `slosh devices calibrate NAME` finds where it\n"
    "stands in the room of a headset.\n"
    "\n"
    "Besides hardware there are always\n"
    "  script, mouse, replay:FILE       see `slosh play --help`\n"
    "  xr-left, xr-right                the controllers of a headset, with --vr\n"
    "  operator[:tight|loose,...]       a simulated person's arm, closing the loop by the force it feels\n"
    "  osc[:[HOST:]PORT][,vrchat=1,...] a tracker that is told of over Open Sound Control\n"
    "  plugin:FILE[:OPTIONS]            any vendor's device behind a C interface:\n"
    "                                   peer/devices/plugin/slosh_device.h\n"
    "\n"
    "How hard a spring a device holds follows from its own damping b and the period T of its loop: K < "
    "2·b/T\n"
    "(Colgate), half of b left for the coupling's damper. A scene that asks for more feels softer there, "
    "and\n"
    "says so; a file that asks for more gets it, with a warning.\n"
    "\n"
    "Settings of a device (axes, gains, scale, buttons) are in $XDG_CONFIG_HOME/slosh/devices/;\n"
    "peer/devices/PROTOCOLS.md has every key.\n"
    "\n"
    "Examples:\n"
    "  slosh devices\n"
    "  slosh devices --live\n"
    "  slosh devices --live --device plugin:build/release/lib/slosh_example_device.so\n"
    "  slosh devices test falcon --force 2 --out falcon_test\n"
    "  slosh devices test operator:loose,correction=0";

struct DevicesOptions {
  bool live = false;
  std::vector<std::string> specs;
  double seconds = 0.0;  ///< of live; 0: until Ctrl-C
  bool install = false;
  std::string rule_file = kUdevRuleFile;
};

std::vector<FoundDevice> show_devices() {
  std::vector<FoundDevice> all = find_hardware();
  if (all.empty())
    std::printf(
        "No SpaceMouse, no gamepad and no Falcon is plugged in. script, mouse, replay, operator and plugin "
        "need none.\n");
  for (const FoundDevice& each : all) {
    std::printf("%s (%s)\n    --device %s\n", each.name.c_str(), each.where.c_str(), each.spec.c_str());
    if (each.problem.empty()) continue;
    std::printf("    cannot be used: %s. %s.\n", each.problem.c_str(), each.mend.c_str());
  }
  // None is no trouble: most who ask here have none.
  const Result<std::unique_ptr<Headset>> headset = Headset::find({});
  if (headset)
    std::printf("%s\n    --vr --device xr-left --device xr-right\n",
                clean_text(headset.value()->description(), kMaxTextBytes).c_str());
  else
    std::printf("No headset: %s. %s.\n", clean_text(headset.error().what, kMaxTextBytes).c_str(),
                headset.error().mend.c_str());
  std::printf("Settings: %s\n", clean_text(device_settings_folder().string(), kMaxTextBytes).c_str());
  return all;
}

int list_devices(const std::string& rule_file) {
  const auto every = [](const std::vector<FoundDevice>& all) {
    return std::all_of(all.begin(), all.end(), [](const FoundDevice& each) { return each.problem.empty(); });
  };
  const std::vector<FoundDevice> all = show_devices();
  if (every(all)) return kExitOk;
  const bool denied =
      std::any_of(all.begin(), all.end(), [](const FoundDevice& each) { return each.denied; });
  if (!denied || !offer_rule(rule_file)) return kExitFailed;
  if (every(find_hardware())) {
    std::printf("They can be used now.\n");
    return kExitOk;
  }
  std::printf("Plug them in again: then they can be used.\n");
  return kExitFailed;
}

/// One open device and the words before its line.
struct Shown {
  std::string spec;
  std::unique_ptr<Device> device;
};

Result<std::vector<Shown>> open_shown(const DevicesOptions& options) {
  std::vector<std::string> specs = options.specs;
  if (specs.empty()) {
    for (const FoundDevice& each : find_hardware()) {
      if (each.problem.empty()) specs.push_back(each.spec);
    }
  }
  if (specs.empty())
    return Error{"devices --live", "there is no device to show", "Plug one in, or name one with --device"};
  std::vector<Shown> shown;
  for (const std::string& spec : specs) {
    Result<std::unique_ptr<Device>> opened = open_named_device(spec);
    if (!opened) return opened.error();
    for (const std::string& warning : opened.value()->warnings())
      std::fprintf(stderr, "slosh: %s\n", clean_text(warning, kMaxTextBytes).c_str());
    shown.push_back({spec, std::move(opened.value())});
  }
  return shown;
}

std::string live_line(const Shown& shown, const DeviceReport& report) {
  const std::string trouble = shown.device->trouble();
  if (!trouble.empty()) return shown.spec + ": " + trouble;
  if (!report.heard) return shown.spec + ": says nothing";
  const glm::dvec3& p = report.pose.position;
  const glm::dvec3 turn = rotation_between({1.0, 0.0, 0.0, 0.0}, report.pose.orientation);
  const std::string text =
      format(": at %8.4f %8.4f %8.4f m, turned %6.3f %6.3f %6.3f rad, buttons %x%s", p.x, p.y, p.z, turn.x,
             turn.y, turn.z, report.buttons, report.engaged ? "" : ", let go");
  const std::string status = shown.device->status();
  return shown.spec + text + (status.empty() ? "" : "; " + status);
}

int show_live(const DevicesOptions& options) {
  Result<std::vector<Shown>> opened = open_shown(options);
  if (!opened) return fail(opened.error());
  std::vector<Shown>& shown = opened.value();
  catch_interrupts();
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::vector<DeviceReport> last(shown.size());
  double next = 0.0;
  bool first = true;
  while (interrupted_by() == 0 && (options.seconds <= 0.0 || elapsed() < options.seconds)) {
    for (std::size_t i = 0; i < shown.size(); ++i) {
      try {
        last[i] = shown[i].device->read({elapsed(), 0.001});
        shown[i].device->write(Wrench{});
      } catch (const std::exception& error) {
        return fail({shown[i].spec, error.what(), "Plug it in again"});
      }
    }
    if (elapsed() >= next) {
      next = elapsed() + (terminal ? 0.1 : 1.0);
      if (terminal && !first) std::printf("\x1b[%zuA", shown.size());
      for (std::size_t i = 0; i < shown.size(); ++i)
        std::printf("%s%s\n", terminal ? "\x1b[K" : "",
                    clean_text(live_line(shown[i], last[i]), 400).c_str());
      std::fflush(stdout);
      first = false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  for (const Shown& each : shown) each.device->close();
  return interrupted_by() == 0 ? kExitOk : 128 + interrupted_by();
}

int devices(const DevicesOptions& options) {
  if (options.install) return install_rule(options.rule_file);
  return options.live ? show_live(options) : list_devices(options.rule_file);
}

}  // namespace

Result<std::unique_ptr<Device>> open_named_device(const std::string& spec) {
  std::optional<Result<std::unique_ptr<Device>>> made = make_hardware(spec, HandPlace{});
  if (!made) {
    return Error{"devices", in_quotes(spec) + " is no device that can be opened without a scene",
                 std::string("Name one of: ") + kHardwareSpecs};
  }
  if (!*made) return made->error();
  std::unique_ptr<Device> device = std::move(made->value());
  if (const Result<bool> opened = open_device(*device); !opened) return opened.error();
  return device;
}

void add_devices(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("devices", "What hands can be held with: list, live values, tests");
  auto o = std::make_shared<DevicesOptions>();
  CLI::Option* live = verb->add_flag("--live", o->live, "Show what they say until Ctrl-C");
  verb->add_option("--device", o->specs, "Show this one; may be given more than once")
      ->allow_extra_args(false)
      ->needs(live);
  verb->add_option("--seconds", o->seconds, "Show for that long")->check(in_range(0.01, 1e6))->needs(live);
  verb->add_flag("--install-udev-rule", o->install, "Let whoever sits at this machine open them");
  verb->add_option("--rule-file", o->rule_file, "Where the rule goes")->capture_default_str();
  verb->footer(kDevicesFooter);
  verb->callback([&chosen, o, verb] {
    if (verb->get_subcommands().empty()) chosen = [o] { return devices(*o); };
  });
  verb->require_subcommand(0, 1);
  add_devices_test(*verb, chosen);
  add_devices_calibrate(*verb, chosen);
}

}  // namespace slosh
