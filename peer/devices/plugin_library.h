// A plug-in's shared library: its functions, each call fenced.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "peer/devices/plugin/slosh_device.h"
#include "sim/math/result.h"

namespace slosh {

/// The functions of plugin/slosh_device.h.
struct PluginLibrary {
  std::string file;
  decltype(&slosh_device_version) version = nullptr;
  decltype(&slosh_device_open) open = nullptr;
  decltype(&slosh_device_get_capabilities) capabilities = nullptr;
  decltype(&slosh_device_read) read = nullptr;
  decltype(&slosh_device_write) write = nullptr;
  decltype(&slosh_device_close) close = nullptr;
  decltype(&slosh_device_move) move = nullptr;  ///< null where it has none: not asked of impedance devices
  decltype(&slosh_device_say) say = nullptr;    ///< null where it has none
};

/// Loads a library and finds its functions. It stays loaded until the process ends: a call of it may never
/// return. Errors: it cannot be loaded, lacks a function of the six, is of a version that this slosh does not
/// know.
Result<PluginLibrary> load_plugin(const std::string& file);

/// Runs `call` on a thread of its own, for `seconds` at most: what it throws or how long it takes is not the
/// caller's. Empty when it returned in time; else what it did, in words. `call` must own what it uses: it may
/// still run when this has returned.
std::string fenced(double seconds, std::function<void()> call);

}  // namespace slosh
