// A join link as somebody types it.
#include <string>
#include <string_view>

#include "net/link.h"
#include "tests/fuzz/must.h"
#include "tests/fuzz/seeds.h"

using namespace slosh;

namespace {

bool same(const JoinLink& a, const JoinLink& b) {
  return a.addresses == b.addresses && a.host == b.host && a.token == b.token;
}

/// The checksum keeps chance inputs from being links: here the input is a link's parts.
void check_parts(std::string_view text) {
  JoinLink link;
  link.addresses.emplace_back();
  for (const char c : text) {
    if (c == ',')
      link.addresses.emplace_back();
    else
      link.addresses.back().push_back(c);
    link.host[static_cast<std::uint8_t>(c) % link.host.size()] += 1;
    link.token[static_cast<std::uint8_t>(c) % link.token.size()] += 3;
  }
  const Result<std::string> written = format_link(link);
  if (!written) return;
  const Result<JoinLink> read = parse_link(written.value());
  test::must(read && same(read.value(), link), "what was written is read");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  check_parts(input);
  const Result<JoinLink> link = parse_link(input);
  if (!link) {
    test::must(wire::text_problem(link.error().text()).empty(), "an error can be told");
    return 0;
  }
  const Result<std::string> text = format_link(link.value());
  test::must(static_cast<bool>(text), "what was parsed can be written");
  const Result<JoinLink> again = parse_link(text.value());
  test::must(again && same(again.value(), link.value()), "and parsed to the same");
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
  const std::string addresses = "192.0.2.7:4433,[2001:db8::7]:1,host.example:65535";
  seeds.emplace_back(addresses.begin(), addresses.end());
  return seeds;
}
