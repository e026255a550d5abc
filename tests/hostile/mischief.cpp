#include "tests/hostile/mischief.h"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace slosh::hostile {

wire::Bytes Mischief::noise(std::size_t most) {
  wire::Bytes out(below(most + 1));
  for (std::uint8_t& byte : out) byte = static_cast<std::uint8_t>(random_());
  return out;
}

std::string Mischief::text(std::size_t most) {
  using namespace std::string_view_literals;
  static constexpr std::string_view kPieces[] = {"\x1b[2J"sv,
                                                 "\x1b]0;owned\x07"sv,
                                                 "\x1b[31m"sv,
                                                 "\r"sv,
                                                 "\n"sv,
                                                 "\0"sv,
                                                 "\x7f"sv,
                                                 "\b"sv,
                                                 "\xc2\x9b"
                                                 "31m"sv,           // CSI in one character
                                                 "\x9b[31m"sv,      // the same as a raw byte
                                                 "\xe2\x80\xae"sv,  // right to left from here
                                                 "\xe2\x80\x8b"sv,  // no width
                                                 "\xef\xbb\xbf"sv,  // no width either
                                                 "\xf0\x9f\x92\xa7"sv,
                                                 "\xff\xfe"sv,
                                                 "Ana"sv,
                                                 "\xd0\x90na"sv,
                                                 "has left"sv,
                                                 "`id`"sv,
                                                 "$(id)"sv,
                                                 "%s%n"sv,
                                                 " "sv,
                                                 "/../../x"sv};
  std::string out;
  const std::size_t wanted = below(most + 1);
  for (int i = 0; i < 1000; ++i) {
    const std::string_view piece = kPieces[below(std::size(kPieces))];
    if (out.size() + piece.size() > wanted) break;
    out += piece;
  }
  return out;
}

void Mischief::turn_bits(wire::Bytes& bytes) {
  for (std::size_t left = 1 + below(6); left > 0 && !bytes.empty(); --left)
    bytes[below(bytes.size())] ^= static_cast<std::uint8_t>(1u << below(8));
}

wire::Bytes Mischief::enveloped(std::uint64_t type, const wire::Bytes& payload) {
  std::uint64_t length = payload.size();
  if (one_in(16)) type = below(64);
  if (one_in(24)) length = any() >> below(64);
  wire::Bytes out;
  for (std::uint64_t value : {type, length}) {
    for (; value >= 0x80; value >>= 7) out.push_back(static_cast<std::uint8_t>(value | 0x80));
    out.push_back(static_cast<std::uint8_t>(value));
  }
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

void Mischief::write_over(wire::Bytes& bytes, const std::string& text) {
  if (text.empty()) return;
  const auto at = std::search_n(bytes.begin(), bytes.end(), static_cast<std::ptrdiff_t>(text.size()),
                                static_cast<std::uint8_t>(kMark));
  if (at != bytes.end()) std::copy(text.begin(), text.end(), at);
}

}  // namespace slosh::hostile
