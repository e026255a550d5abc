// A line typed at a running host.
#include <cmath>
#include <string>

#include "host/server/console.h"
#include "net/wire/text.h"
#include "tests/fuzz/must.h"
#include "tests/fuzz/seeds.h"

using namespace slosh;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  const Result<ConsoleCommand> command = parse_console(line);
  if (!command) {
    test::must(!command.error().text().empty(), "a refusal has words");
    test::must(wire::text_problem(command.error().text()).empty(), "that can be shown");
    return 0;
  }
  const ConsoleCommand& c = command.value();
  test::must(wire::text_problem(c.text).empty(), "a name can be shown");
  test::must(c.lifetime_ns >= 0 && c.value >= 0.0 && std::isfinite(c.value), "numbers are in range");
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  std::vector<std::vector<std::uint8_t>> seeds;
  for (const std::string line : {"help", "who", "links", "link \"Ana Maria\" watch for 1h30m", "revoke bako",
                                 "expire bako never", "release 'left'", "kick Ana", "pause", "continue",
                                 "reset", "set viscosity honey 1e1", "set gravity 0.5", "status", "quit\r\n", "link \xdc\xbentc2"})
    seeds.emplace_back(line.begin(), line.end());
  return seeds;
}
