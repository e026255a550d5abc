#include "net/link.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace slosh {
namespace {

using wire::Bytes;
using wire::ByteView;

constexpr std::string_view kScheme = "slosh://";
constexpr std::string_view kDigits = "abcdefghijklmnopqrstuvwxyz234567";
constexpr std::size_t kMaxAddress = 260;
constexpr std::size_t kCheckBytes = 4;
constexpr char kAskAgain[] = "Copy the whole link anew, or ask for it again";
constexpr char kDamaged[] = "the link is cut off or mistyped";

std::string version_text() {
  return std::string("v") + std::to_string(kLinkVersion);
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

std::size_t base32_length(std::size_t bytes) {
  return (8 * bytes + 4) / 5;
}

/// CRC-32 finds every change within 32 bits on end, so every changed character.
std::uint32_t check_of(const std::vector<std::string>& addresses, ByteView key, ByteView token) {
  const std::string version = version_text() + ',';
  Bytes all(version.begin(), version.end());
  for (const std::string& address : addresses) {
    for (const char c : address) all.push_back(static_cast<std::uint8_t>(lower(c)));
    all.push_back(',');
  }
  all.insert(all.end(), key.begin(), key.end());
  all.insert(all.end(), token.begin(), token.end());
  return static_cast<std::uint32_t>(::crc32_z(0, all.data(), all.size()));
}

bool all_of(std::string_view text, std::string_view extra) {
  return std::all_of(text.begin(), text.end(), [&](char c) {
    const char l = lower(c);
    return (l >= 'a' && l <= 'z') || (l >= '0' && l <= '9') || extra.find(c) != std::string_view::npos;
  });
}

/// What is wrong with "HOST:PORT" or "[IPv6]:PORT"; empty when nothing is. Whether the host exists is for
/// the connection to find out.
std::string address_problem(std::string_view address) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string_view::npos) return "has no port";
  std::string_view host = address.substr(0, colon);
  const std::string_view port = address.substr(colon + 1);
  int number = 0;
  const auto [end, code] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (code != std::errc{} || end != port.data() + port.size() || number < 1 || number > 65535)
    return "has no port from 1 to 65535";
  if (address.size() > kMaxAddress) return "is too long";
  if (host.size() > 1 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
    const bool fine = host.find(':') != std::string_view::npos && all_of(host, ":.%_-");
    return fine ? "" : "is not an IPv6 address in brackets";
  }
  if (host.empty() || !all_of(host, ".-_")) return "is not a name or an IP address (IPv6 in brackets)";
  return "";
}

Error bad_link(std::string what, std::string mend = kAskAgain) {
  return {"link", std::move(what), std::move(mend)};
}

std::optional<Error> check_addresses(const std::vector<std::string>& addresses) {
  if (addresses.size() > kMaxLinkAddresses)
    return bad_link("it has " + std::to_string(addresses.size()) + " addresses, more than " +
                    std::to_string(kMaxLinkAddresses));
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    const std::string problem = address_problem(addresses[i]);
    if (!problem.empty())
      return bad_link("address " + std::to_string(i + 1) + " '" + wire::clean_text(addresses[i], 60) + "' " +
                      problem);
  }
  return std::nullopt;
}

/// One part of the link in base32, of exactly `bytes` bytes.
Result<Bytes> from_base32(std::string_view text, std::size_t bytes, const std::string& part) {
  const std::size_t wanted = base32_length(bytes);
  Bytes out;
  std::uint32_t held = 0;
  int bits = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(lower(c));
    if (digit == std::string_view::npos)
      return bad_link(part +
                      " has a character that is neither a letter nor one of the digits 2 to 7: " + kDamaged);
    held = (held << 5 | static_cast<std::uint32_t>(digit)) & 0xffff;
    bits += 5;
    if (bits < 8) continue;
    bits -= 8;
    out.push_back(static_cast<std::uint8_t>(held >> bits));
  }
  if (text.size() != wanted)
    return bad_link(part + " is " + std::to_string(text.size()) + " characters long and not " +
                    std::to_string(wanted) + ": " + kDamaged);
  if ((held & ((1u << bits) - 1)) != 0) return bad_link(part + " ends in a wrong character: " + kDamaged);
  return out;
}

/// Without what mail and shells put in and around.
std::string bare(std::string_view text) {
  std::string out;
  bool line_start = true;
  for (const char c : text) {
    const bool space = c == ' ' || c == '\t' || c == '\r' || c == '\n';
    const bool quoting = c == '>' && line_start;
    if (c == '\n')
      line_start = true;
    else if (!space && !quoting)
      line_start = false;
    if (!space && !quoting) out.push_back(c);
  }
  const auto is_around = [](char c) { return c == '"' || c == '\'' || c == '`' || c == '<' || c == '>'; };
  while (!out.empty() && is_around(out.back())) out.pop_back();
  const auto begin = std::find_if_not(out.begin(), out.end(), is_around);
  return {begin, out.end()};
}

std::optional<int> version_of(std::string_view part) {
  if (part.size() < 2 || part.size() > 5 || lower(part[0]) != 'v' || part[1] == '0') return std::nullopt;
  int version = 0;
  const auto [end, code] = std::from_chars(part.data() + 1, part.data() + part.size(), version);
  if (code != std::errc{} || end != part.data() + part.size()) return std::nullopt;
  return version;
}

std::optional<Error> check_version(const std::vector<std::string>& parts) {
  const std::optional<int> version = version_of(parts[0]);
  if (version == kLinkVersion) return std::nullopt;
  // The first form began with addresses and had three parts.
  const bool first_form =
      !version && parts.size() == 3 && address_problem(parts[0].substr(0, parts[0].find(','))).empty();
  if (first_form || (version && *version < kLinkVersion))
    return bad_link("it is of an older slosh",
                    "Ask the host for a new one; host and peers need the same slosh");
  if (version)
    return bad_link("it is of a newer slosh: version " + std::to_string(*version) +
                        " of the links, and this one reads " + std::to_string(kLinkVersion),
                    "Use the slosh that the host uses");
  return bad_link(std::string("it does not say which version it is (v") + std::to_string(kLinkVersion) +
                  "): " + kDamaged);
}

std::vector<std::string> split(std::string_view text, char by) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == by)
      parts.emplace_back();
    else
      parts.back().push_back(c);
  }
  return parts;
}

}  // namespace

std::string to_base32(ByteView bytes) {
  std::string out;
  std::uint32_t held = 0;
  int bits = 0;
  for (const std::uint8_t byte : bytes) {
    held = (held << 8 | byte) & 0xfff;
    bits += 8;
    for (; bits >= 5; bits -= 5) out.push_back(kDigits[held >> (bits - 5) & 31]);
  }
  if (bits > 0) out.push_back(kDigits[held << (5 - bits) & 31]);
  return out;
}

Result<std::string> format_link(const JoinLink& link) {
  if (link.addresses.empty()) return bad_link("it has no address", "Name one with --listen");
  if (std::optional<Error> error = check_addresses(link.addresses)) return *error;
  std::string out = std::string(kScheme) + version_text() + "/";
  for (std::size_t i = 0; i < link.addresses.size(); ++i) out += (i == 0 ? "" : ",") + link.addresses[i];
  Bytes token(link.token.begin(), link.token.end());
  const std::uint32_t check = check_of(link.addresses, link.host, token);
  for (std::size_t i = 0; i < kCheckBytes; ++i) token.push_back(static_cast<std::uint8_t>(check >> (8 * i)));
  return out + "/" + to_base32(link.host) + "/" + to_base32(token);
}

std::string shorten_links(std::string_view text) {
  std::string out;
  while (true) {
    const auto found = std::search(text.begin(), text.end(), kScheme.begin(), kScheme.end(),
                                   [](char a, char b) { return lower(a) == b; });
    const auto at = static_cast<std::size_t>(found - text.begin());
    if (at == text.size()) return out.append(text);
    const std::size_t end = std::min(text.find_first_of(" \t\r\n\"'<>", at), text.size());
    const std::string_view link = text.substr(at, end - at);
    const std::size_t version = link.find('/', kScheme.size());
    const std::size_t addresses = version == std::string_view::npos ? version : link.find('/', version + 1);
    const std::size_t kept = addresses == std::string_view::npos ? kScheme.size() : addresses + 1;
    out.append(text.substr(0, at)).append(link.substr(0, kept)).append("…");
    text.remove_prefix(end);
  }
}

Result<JoinLink> parse_link(std::string_view text) {
  if (text.size() > kMaxLinkText) return bad_link("it is too long for a link");
  const std::string link = bare(text);
  if (link.empty()) return bad_link("it is empty");
  std::string start = link.substr(0, kScheme.size());
  std::transform(start.begin(), start.end(), start.begin(), lower);
  if (start != kScheme) return bad_link("it does not begin with slosh://");
  std::vector<std::string> parts = split(std::string_view(link).substr(kScheme.size()), '/');
  if (std::optional<Error> error = check_version(parts)) return *error;
  parts.erase(parts.begin());
  if (parts.size() < 3)
    return bad_link(parts.size() < 2 ? std::string("the host's key and the token are missing: ") + kDamaged
                                     : std::string("the token is missing: ") + kDamaged);
  if (parts.size() > 3) return bad_link(std::string("it has more than four parts: ") + kDamaged);

  JoinLink out;
  out.addresses = split(parts[0], ',');
  if (std::optional<Error> error = check_addresses(out.addresses)) return *error;
  const Result<Bytes> key = from_base32(parts[1], out.host.size(), "the host's key");
  if (!key) return key.error();
  const Result<Bytes> token = from_base32(parts[2], out.token.size() + kCheckBytes, "the token");
  if (!token) return token.error();
  std::copy(key.value().begin(), key.value().end(), out.host.begin());
  std::copy_n(token.value().begin(), out.token.size(), out.token.begin());
  std::uint32_t check = 0;
  for (std::size_t i = 0; i < kCheckBytes; ++i)
    check |= std::uint32_t{token.value()[out.token.size() + i]} << (8 * i);
  if (check != check_of(out.addresses, out.host, out.token))
    return bad_link(std::string("its parts do not fit together: ") + kDamaged);
  return out;
}

}  // namespace slosh
