#include "net/wire/text.h"

#include <cstdint>

namespace slosh::wire {
namespace {

/// Bytes of the character at the front, 0 when there is no UTF-8 character; its code point.
std::size_t character(std::string_view text, std::uint32_t& code) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  code = first;
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || length > text.size()) return 0;
  code = first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  if (length == 3 && code < 0x800) return 0;
  if (length == 4 && (code < 0x10000 || code > 0x10ffff)) return 0;
  return code >= 0xd800 && code <= 0xdfff ? 0 : length;
}

bool is_control(std::uint32_t code) {
  if (code < 0x20 || (code >= 0x7f && code <= 0x9f)) return true;
  return code == 0x61c || code == 0x200e || code == 0x200f || (code >= 0x2028 && code <= 0x202e) ||
         (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

std::string text_problem(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    std::uint32_t code = 0;
    const std::size_t length = character(text.substr(at), code);
    if (length == 0) return "is not UTF-8 at byte " + std::to_string(at);
    if (is_control(code)) return "has a control character at byte " + std::to_string(at);
    at += length;
  }
  return "";
}

std::string clean_text(std::string_view text, std::size_t most) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    std::uint32_t code = 0;
    const std::size_t length = character(text.substr(at), code);
    const bool fine = length > 0 && !is_control(code);
    const std::string_view piece = fine ? text.substr(at, length) : std::string_view("?");
    if (out.size() + piece.size() > most) break;
    out += piece;
    at += length > 0 ? length : 1;
  }
  return out;
}

}  // namespace slosh::wire
