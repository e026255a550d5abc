// The parts of the verb `devices`.
#pragma once

#include <memory>
#include <string>

#include "peer/app/verbs.h"
#include "peer/haptics/device.h"

namespace slosh {

/// Add `test` and `calibrate`, a haptic device and a headset in one space, to `devices`.
void add_devices_test(CLI::App& devices, VerbRun& chosen);
void add_devices_calibrate(CLI::App& devices, VerbRun& chosen);

/// The open device that `spec` names, apart from any scene. Errors: it is none of kHardwareSpecs, or cannot
/// be opened.
Result<std::unique_ptr<Device>> open_named_device(const std::string& spec);

/// `--install-udev-rule`: writes the udev rule that lets whoever sits at the machine open devices to `file`,
/// and where that is the machine's own place has udev take it up at once. The exit code.
int install_rule(const std::string& file);

/// What follows a list of devices of which some may not be opened: the rule, and the command that puts it in
/// place. Where somebody sits at a terminal they are asked whether that is to be done now, and only a yes
/// runs it, through sudo where this user may not write there. True when the rule is in place by that.
bool offer_rule(const std::string& file);

}  // namespace slosh
