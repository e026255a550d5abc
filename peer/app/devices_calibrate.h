// `devices calibrate`: a haptic device and a headset in one space.
#pragma once

#include <CLI/App.hpp>

#include "peer/app/verbs.h"

namespace slosh {

void add_devices_calibrate(CLI::App& devices, VerbRun& chosen);

}  // namespace slosh
