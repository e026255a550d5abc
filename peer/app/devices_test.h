// `slosh devices test NAME`.
#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <string>

#include "peer/app/verbs.h"
#include "peer/haptics/device.h"

namespace slosh {

/// Adds the subcommand to `devices`.
void add_devices_test(CLI::App& devices, VerbRun& chosen);

/// The open device that `spec` names, apart from any scene. Errors: it is none of kHardwareSpecs, or cannot
/// be opened.
Result<std::unique_ptr<Device>> open_named_device(const std::string& spec);

}  // namespace slosh
