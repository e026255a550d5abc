// A join link: all that a newcomer needs.
//
//   slosh://v2/ADDRESS[,ADDRESS…]/KEY/TOKEN
//
// v2 is the form's version: a link of another one is told so, not called damaged (the first had none and
// began with its addresses). KEY is the host's fingerprint (32 bytes) and TOKEN the token (16 bytes) with a
// CRC-32 of everything (4 bytes, little-endian) behind it, both in lower-case base32 (RFC 4648, no padding):
// letters and digits only, so that mail programs and shells leave them alone, and 52 and 32 characters long.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "net/quic/endpoint.h"
#include "net/wire/messages.h"
#include "sim/math/result.h"

namespace slosh {

struct JoinLink {
  std::vector<std::string> addresses;  ///< "HOST:PORT" or "[IPv6]:PORT", 1 to kMaxLinkAddresses
  KeyFingerprint host{};
  wire::Token token{};
};

constexpr int kLinkVersion = 2;
constexpr std::size_t kMaxLinkAddresses = 8;
constexpr std::size_t kMaxLinkText = 4096;  ///< characters that parse_link looks at

/// Errors: no address, too many, or one that is not an address with a port.
Result<std::string> format_link(const JoinLink& link);

/// Tolerates what mail and shells add: space and line breaks anywhere (also with ">" at a line's start),
/// quotes and angle brackets around it, capitals. Errors say which part is damaged, or that the link is of an
/// older or newer slosh; a changed or missing character is always found.
Result<JoinLink> parse_link(std::string_view text);

/// `text` with each link in it cut off behind its addresses, so that it opens nothing:
/// "slosh://v2/192.0.2.7:4433/…".
std::string shorten_links(std::string_view text);

/// The lower-case base32 of the link: 8 characters for 5 bytes, no padding.
std::string to_base32(wire::ByteView bytes);

}  // namespace slosh
