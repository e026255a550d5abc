// A join link as somebody types it.
#include <string>

#include "net/link.h"
#include "tests/fuzz/must.h"
#include "tests/fuzz/seeds.h"

using namespace slosh;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Result<JoinLink> link = parse_link({reinterpret_cast<const char*>(data), size});
  if (!link) {
    test::must(wire::text_problem(link.error().text()).empty(), "an error can be told");
    return 0;
  }
  const Result<std::string> text = format_link(link.value());
  test::must(static_cast<bool>(text), "what was parsed can be written");
  const Result<JoinLink> again = parse_link(text.value());
  test::must(static_cast<bool>(again), "and parsed");
  test::must(again.value().addresses == link.value().addresses && again.value().host == link.value().host &&
                 again.value().token == link.value().token,
             "to the same");
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  std::vector<std::vector<std::uint8_t>> seeds;
  for (std::uint8_t i = 0; i < 6; ++i) {
    JoinLink link;
    link.addresses = {"192.0.2.7:4433", "[2001:db8::7]:1", "host.example:65535"};
    link.addresses.resize(1 + i % 3u);
    link.host.fill(static_cast<std::uint8_t>(37 * i));
    link.token.fill(static_cast<std::uint8_t>(11 * i));
    std::string text = format_link(link).value();
    if (i > 3) text = " <" + text.substr(0, 30) + "\r\n> " + text.substr(30) + ">";
    seeds.emplace_back(text.begin(), text.end());
  }
  return seeds;
}
