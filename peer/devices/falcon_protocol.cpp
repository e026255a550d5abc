#include "peer/devices/falcon_protocol.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace slosh {
namespace {

// Requests of the FTDI chip.
constexpr std::uint8_t kReset = 0, kModem = 1, kFlow = 2, kBaud = 3, kData = 4, kLatency = 9;
constexpr std::uint16_t kPurgeIn = 1, kPurgeOut = 2;
constexpr std::uint16_t kRtsLow = 0x0200, kDtrLow = 0x0100, kDtrHigh = 0x0101;
constexpr std::uint16_t kBaud9600 = 0x4138, kBaud140000 = 0x0015, kBaudOfPackets = 2;
constexpr int kPatience = 3000;     // ms for an answer
constexpr std::size_t kPiece = 62;  // bytes of firmware at once: what one IN packet can bring back

constexpr std::uint8_t kFirst = '<', kLast = '>', kNibble = 0x41;

/// Reads `wanted` bytes, or what came of them in time.
std::vector<std::uint8_t> read_all(FalconLink& link, std::size_t wanted) {
  std::vector<std::uint8_t> got;
  std::array<std::uint8_t, 64> bytes{};
  while (got.size() < wanted) {
    const int size = link.read(bytes.data(), std::min(bytes.size(), wanted - got.size()), kPatience);
    if (size <= 0) break;
    got.insert(got.end(), bytes.begin(), bytes.begin() + size);
  }
  return got;
}

std::string hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    char two[4];
    std::snprintf(two, sizeof two, "%02x ", byte);
    text += two;
  }
  return text.empty() ? std::string("nothing") : text.substr(0, text.size() - 1);
}

Error refused(const FalconLink& link, const std::string& what) {
  return {link.where(), what, "Unplug it and its power, wait for some seconds, plug both in and try again"};
}

Result<bool> expect(FalconLink& link, const std::vector<std::uint8_t>& sent,
                    const std::vector<std::uint8_t>& wanted, const char* step) {
  if (!link.write(sent.data(), sent.size(), kPatience))
    return refused(link, std::string("it takes no bytes (") + step + ")");
  const std::vector<std::uint8_t> got = read_all(link, wanted.size());
  if (got == wanted) return true;
  return refused(link, std::string(step) + ": it answers " + hex(got) + " in place of " + hex(wanted));
}

bool all(FalconLink& link, std::initializer_list<std::pair<std::uint8_t, std::uint16_t>> requests) {
  return std::all_of(requests.begin(), requests.end(),
                     [&](const auto& each) { return link.control(each.first, each.second); });
}

void put(std::uint8_t* at, int value) {
  const auto bits = static_cast<std::uint16_t>(static_cast<std::int16_t>(value));
  for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(kNibble + ((bits >> (4 * i)) & 0xf));
}

bool take(const std::uint8_t* at, int& value) {
  std::uint16_t bits = 0;
  for (int i = 0; i < 4; ++i) {
    if (at[i] < kNibble || at[i] > kNibble + 0xf) return false;
    bits = static_cast<std::uint16_t>(bits | ((at[i] - kNibble) << (4 * i)));
  }
  value = static_cast<std::int16_t>(bits);
  return true;
}

}  // namespace

Result<bool> send_falcon_firmware(FalconLink& link, const std::vector<std::uint8_t>& firmware) {
  const bool greeted = all(link, {{kReset, kPurgeIn},
                                  {kReset, kPurgeOut},
                                  {kLatency, 16},
                                  {kBaud, kBaud9600},
                                  {kData, 8},
                                  {kFlow, 0},
                                  {kModem, kRtsLow},
                                  {kModem, kDtrLow},
                                  {kModem, kDtrHigh}});
  if (!greeted) return refused(link, "its USB chip refuses a request before the greeting");
  Result<bool> step = expect(link, {0x0a, 0x43, 0x0d}, {0x0a, 0x44, 0x2c, 0x0d}, "greeting");
  if (!step) return step;
  if (!all(link, {{kModem, kDtrLow}, {kBaud, kBaud140000}}))
    return refused(link, "its USB chip refuses the firmware's speed");
  step = expect(link, {0x41}, {0x41}, "the loader's sign");
  if (!step) return step;
  for (std::size_t at = 0; at < firmware.size(); at += kPiece) {
    const std::size_t end = std::min(at + kPiece, firmware.size());
    const std::vector<std::uint8_t> piece(firmware.begin() + static_cast<std::ptrdiff_t>(at),
                                          firmware.begin() + static_cast<std::ptrdiff_t>(end));
    if (!link.write(piece.data(), piece.size(), kPatience))
      return refused(link, "it takes no firmware at byte " + std::to_string(at));
    const std::vector<std::uint8_t> echo = read_all(link, piece.size());
    if (echo == piece) continue;
    const auto [sent, came] = std::mismatch(piece.begin(), piece.end(), echo.begin(), echo.end());
    const auto byte = static_cast<std::size_t>(sent - piece.begin());
    Error error =
        refused(link, "the firmware came back otherwise at byte " + std::to_string(at + byte) + " of " +
                          std::to_string(firmware.size()) + ": " + hex({*sent}) + " was sent, " +
                          (came == echo.end() ? "nothing" : hex({*came})) + " came");
    error.mend += "; where that byte changes from time to time, by another cable or port";
    return error;
  }
  return true;
}

bool begin_falcon_packets(FalconLink& link) {
  return all(link, {{kLatency, 1}, {kBaud, kBaudOfPackets}, {kReset, kPurgeIn}, {kReset, kPurgeOut}});
}

std::optional<FalconState> parse_falcon(const FalconPacket& packet) {
  if (packet[0] != kFirst || packet[kFalconPacket - 1] != kLast) return std::nullopt;
  FalconState state;
  for (std::size_t i = 0; i < 3; ++i)
    if (!take(&packet[1 + 4 * i], state.counts[i])) return std::nullopt;
  const int status = packet[13] - kNibble;
  state.buttons = static_cast<std::uint8_t>(status & 0x0f);
  state.homed = (status & 0x70) == 0x70;
  return state;
}

FalconPacket falcon_command(const std::array<int, 3>& motors, std::uint8_t lights) {
  constexpr int kMax = 4096;
  FalconPacket packet{};
  packet[0] = kFirst;
  for (std::size_t i = 0; i < 3; ++i) put(&packet[1 + 4 * i], std::clamp(motors[i], -kMax, kMax));
  packet[13] = static_cast<std::uint8_t>(kNibble + lights);
  packet[14] = kNibble;
  packet[15] = kLast;
  return packet;
}

std::optional<FalconState> FalconStream::add(const std::uint8_t* bytes, std::size_t size) {
  if (size > kept_.size()) {
    bytes += size - kept_.size();
    size = kept_.size();
  }
  if (size_ + size > kept_.size()) {  // the oldest go
    const std::size_t drop = size_ + size - kept_.size();
    std::memmove(kept_.data(), kept_.data() + drop, size_ - drop);
    size_ -= drop;
  }
  std::copy_n(bytes, size, kept_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += size;
  std::optional<FalconState> newest;
  std::size_t used = 0;
  for (std::size_t at = 0; at + kFalconPacket <= size_;) {
    FalconPacket packet{};
    std::copy_n(kept_.data() + at, kFalconPacket, packet.begin());
    const std::optional<FalconState> state = parse_falcon(packet);
    at += state ? kFalconPacket : 1;
    used = at;
    if (state) newest = state;
  }
  std::memmove(kept_.data(), kept_.data() + used, size_ - used);
  size_ -= used;
  return newest;
}

}  // namespace slosh
