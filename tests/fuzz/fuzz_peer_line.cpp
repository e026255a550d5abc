// A line typed at a running `join` or `watch`.
#include <cmath>
#include <string>

#include "net/wire/text.h"
#include "peer/remote/peer_console.h"
#include "tests/fuzz/must.h"
#include "tests/fuzz/seeds.h"
#include "tests/support/joined.h"

using namespace slosh;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const test::Joined joined;
  const PeerLine line =
      peer_line({reinterpret_cast<const char*>(data), size}, joined.status, joined.scene, 0.02, 0);
  for (const RemoteCommand& command : line.commands) {
    test::must(command.grip < joined.scene.grips.size(), "a grip that there is");
    test::must(command.index < joined.scene.fluids.size(), "a fluid that there is");
    test::must(command.value >= 0.0 && std::isfinite(command.value), "numbers are in range");
  }
  for (std::size_t at = 0; at < line.text.size();) {
    const std::size_t end = std::min(line.text.find('\n', at), line.text.size());
    test::must(wire::text_problem(std::string_view(line.text).substr(at, end - at)).empty(),
               "answers can be shown");
    at = end + 1;
  }
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  std::vector<std::vector<std::uint8_t>> seeds;
  for (const std::string line : {"help", "who", "take", "take left", "take 'right hand'", "take 1", "release",
                                 "release left", "pause", "continue", "reset", "set viscosity honey 1e1",
                                 "set viscosity 0 0.5", "set gravity 0.5", "status", "quit\r\n"})
    seeds.emplace_back(line.begin(), line.end());
  return seeds;
}
