#include "sites.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace slosh::test {
namespace {

bool run(const std::string& command) {
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace

Sites::Sites(std::vector<std::string> names)
    : names_(std::move(names)), prefix_("slosh" + std::to_string(getpid())) {
  separate_ = !names_.empty() && build();
  if (!separate_ && !names_.empty()) remove();
  std::printf("sites: %s\n", separate_ ? "a network namespace each" : "no namespaces here: all on loopback");
}

Sites::~Sites() {
  if (separate_) remove();
}

bool Sites::build() {
  if (geteuid() != 0) return false;
  if (!run("ip netns add " + space("wire"))) return false;
  for (const std::string& name : names_) {
    // A veth pair's ends may be named at once in the namespaces that they belong to.
    const std::string n = std::to_string(number(name));
    const std::string near = "ip -n " + space(name) + " ";
    const std::string far = "ip -n " + space("wire") + " ";
    if (!run("ip netns add " + space(name)) ||
        !run("ip link add eth0 netns " + space(name) + " type veth peer name site" + n + " netns " +
             space("wire")) ||
        !run(near + "addr add 10.77." + n + ".2/24 dev eth0") || !run(near + "link set eth0 up") ||
        !run(near + "link set lo up") || !run(far + "addr add 10.77." + n + ".1/24 dev site" + n) ||
        !run(far + "link set site" + n + " up")) {
      return false;
    }
  }
  return run("ip -n " + space("wire") + " link set lo up");
}

void Sites::remove() {
  for (const std::string& name : names_) run("ip netns del " + space(name));
  run("ip netns del " + space("wire"));
}

int Sites::number(const std::string& site) const {
  return static_cast<int>(std::find(names_.begin(), names_.end(), site) - names_.begin());
}

std::string Sites::space(const std::string& site) const {
  return prefix_ + "-" + site;
}

std::vector<std::string> Sites::at(const std::string& site, std::vector<std::string> command) const {
  if (separate_) command.insert(command.begin(), {"ip", "netns", "exec", space(site)});
  return command;
}

std::string Sites::address(const std::string& site) const {
  return separate_ ? "10.77." + std::to_string(number(site)) + ".2" : "127.0.0.1";
}

std::string Sites::wire_address(const std::string& site) const {
  return separate_ ? "10.77." + std::to_string(number(site)) + ".1" : "127.0.0.1";
}

}  // namespace slosh::test
