#include "peer/output/machine.h"

#include <sched.h>

#include <algorithm>
#include <fstream>

namespace slosh {
namespace {

/// What follows `separator` on the first line of `file` that starts with `key`.
std::string value_of(const char* file, const std::string& key, char separator) {
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t at = line.find(separator);
    if (at == std::string::npos) continue;
    std::string value = line.substr(at + 1);
    std::erase(value, '"');
    const std::size_t begin = value.find_first_not_of(' ');
    return begin == std::string::npos ? std::string() : value.substr(begin);
  }
  return "unknown";
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.cpu = value_of("/proc/cpuinfo", "model name", ':');
  machine.system = value_of("/etc/os-release", "PRETTY_NAME", '=');
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) machine.cores = std::max(1, CPU_COUNT(&allowed));
  return machine;
}

}  // namespace slosh
