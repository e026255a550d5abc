#include "peer/devices/plugin_library.h"

#include <dlfcn.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "net/text/clean.h"

namespace slosh {
namespace {

struct Call {
  std::mutex mutex;
  std::condition_variable ended;
  bool over = false;
  std::string threw;
};

template <class F>
bool find(void* library, const char* name, F& function) {
  function = reinterpret_cast<F>(dlsym(library, name));
  return function != nullptr;
}

const char* missing_function(void* library, PluginLibrary& p) {
  if (!find(library, "slosh_device_open", p.open)) return "slosh_device_open";
  if (!find(library, "slosh_device_get_capabilities", p.capabilities)) return "slosh_device_get_capabilities";
  if (!find(library, "slosh_device_read", p.read)) return "slosh_device_read";
  if (!find(library, "slosh_device_write", p.write)) return "slosh_device_write";
  if (!find(library, "slosh_device_close", p.close)) return "slosh_device_close";
  return nullptr;
}

Error lacks(const std::string& where, const char* function) {
  return {where, std::string("it lacks the function ") + function,
          "A plug-in has the six functions of peer/devices/plugin/slosh_device.h; rebuild it with that"};
}

}  // namespace

std::string fenced(double seconds, std::function<void()> call) {
  auto state = std::make_shared<Call>();
  std::thread([state, call = std::move(call)] {
    std::string threw;
    try {
      call();
    } catch (const std::exception& error) {
      threw = "threw: " + clean_text(error.what(), 200);
    } catch (...) {
      threw = "threw an exception without words";
    }
    const std::lock_guard lock(state->mutex);
    state->threw = threw;
    state->over = true;
    state->ended.notify_all();
  }).detach();
  std::unique_lock lock(state->mutex);
  const bool over =
      state->ended.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return state->over; });
  if (over) return state->threw;
  return "did not return within " + std::to_string(static_cast<int>(seconds)) + " s";
}

Result<PluginLibrary> load_plugin(const std::string& file) {
  const std::string where = "plug-in " + file;
  PluginLibrary plugin;
  plugin.file = file;
  // A name without a folder would be looked for in the system's libraries.
  const std::string path = file.find('/') == std::string::npos ? "./" + file : file;
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const why = dlerror();
    return Error{where, "cannot be loaded: " + clean_text(why != nullptr ? why : "no reason given", 300),
                 "Give the path of a shared library built for this machine"};
  }
  // Its version first: another one may have other functions.
  if (!find(library, "slosh_device_version", plugin.version)) return lacks(where, "slosh_device_version");
  const std::uint32_t version = plugin.version();
  // Older ones fill the beginning of the structures, of which the rest is zero.
  if (version < 1 || version > SLOSH_DEVICE_VERSION) {
    return Error{where,
                 "it is of version " + std::to_string(version) +
                     " of the plug-in interface, and this slosh knows 1 to " +
                     std::to_string(SLOSH_DEVICE_VERSION),
                 "Rebuild it with this slosh's peer/devices/plugin/slosh_device.h"};
  }
  if (const char* const missing = missing_function(library, plugin)) return lacks(where, missing);
  if (version >= 2) (void)find(library, "slosh_device_move", plugin.move);
  if (version >= 3) (void)find(library, "slosh_device_say", plugin.say);
  return plugin;
}

}  // namespace slosh
