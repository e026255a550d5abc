// The Novint Falcon's protocol above USB: firmware, then packets of 16 bytes both ways.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

/// The transfers that the Falcon's USB chip (an FTDI) knows. Times in ms.
class FalconLink {
 public:
  virtual ~FalconLink() = default;
  /// A vendor's control request to the chip (bmRequestType 0x40).
  virtual bool control(std::uint8_t request, std::uint16_t value) = 0;
  /// All of it to bulk OUT; false when it did not go.
  virtual bool write(const std::uint8_t* bytes, std::size_t size, int most_ms) = 0;
  /// From bulk IN, without the two modem bytes that begin each of its packets: how many, 0 when nothing came
  /// in time, −1 when the device is gone.
  virtual int read(std::uint8_t* bytes, std::size_t most, int most_ms) = 0;
  /// Which device it is of, for errors.
  virtual std::string where() const = 0;
};

/// Restarts the device's processor, greets it and sends it its firmware, checking that every piece comes back
/// as it went. Errors: of which device, which step, and what came instead.
Result<bool> send_falcon_firmware(FalconLink& link, const std::vector<std::uint8_t>& firmware);

/// Sets the link to the pace of packets: 1 ms. False when the chip refuses.
bool begin_falcon_packets(FalconLink& link);

constexpr std::size_t kFalconPacket = 16;
using FalconPacket = std::array<std::uint8_t, kFalconPacket>;

/// From the device.
struct FalconState {
  std::array<int, 3> counts{};  ///< encoders
  std::uint8_t buttons = 0;     ///< 1 plus, 2 forward, 4 centre, 8 minus
  bool homed = false;           ///< all three arms know where they are
};
/// Nothing where it is no packet.
std::optional<FalconState> parse_falcon(const FalconPacket& packet);

constexpr std::uint8_t kFalconHoming = 1;  ///< lets the encoders find their zero
constexpr std::uint8_t kFalconGreen = 2;
constexpr std::uint8_t kFalconBlue = 4;
constexpr std::uint8_t kFalconRed = 8;
/// To the device: motor values −4096 to 4096 and lights.
FalconPacket falcon_command(const std::array<int, 3>& motors, std::uint8_t lights);

/// Packets out of a stream of bytes that may begin and end anywhere.
class FalconStream {
 public:
  /// The newest whole packet in what came so far; bytes before it are passed over.
  std::optional<FalconState> add(const std::uint8_t* bytes, std::size_t size);

 private:
  std::array<std::uint8_t, 256> kept_{};
  std::size_t size_ = 0;
};

}  // namespace slosh
