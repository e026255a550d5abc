// A Falcon at the level of USB transfers: its chip, its loader and its firmware's packets, on a clock of its
// own.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "peer/devices/falcon_kinematics.h"
#include "peer/devices/falcon_protocol.h"

namespace slosh::test {

/// What the device is, beyond the link that a driver opens and closes.
struct FakeFalcon {
  // Set by tests.
  std::vector<std::uint8_t> firmware;  ///< that it has; empty after power-up
  std::size_t corrupt_at = SIZE_MAX;   ///< this byte of the firmware comes back otherwise
  bool deaf = false;                   ///< answers no greeting
  bool homed = true;
  bool silent = false;  ///< answers no packet
  bool gone = false;
  glm::dvec3 grip{0.0, 0.0, kFalconMiddle};
  glm::dvec3 velocity{0.0};  ///< m/s
  std::uint8_t buttons = 0;
  bool counts = false;  ///< its buttons count its reports, so that one that is missing or comes twice is seen
  std::size_t chop = 62;  ///< bytes an IN packet brings at most

  // What happened.
  std::int64_t now_ns = 1'000'000'000;
  std::vector<std::uint8_t> received;         ///< as firmware
  std::vector<std::pair<int, int>> requests;  ///< of the chip
  std::vector<FalconPacket> commands;

  std::deque<std::uint8_t> out;  ///< waits to be read
  enum class Step { kOff, kGreeted, kLoading, kRuns } step = Step::kOff;
};

class FakeFalconLink final : public FalconLink {
 public:
  explicit FakeFalconLink(FakeFalcon& falcon) : f_(falcon) {}

  bool control(std::uint8_t request, std::uint16_t value) override {
    f_.requests.emplace_back(request, value);
    if (request == 0) f_.out.clear();
    if (request == 1 && value == 0x0101 && f_.received.empty()) f_.step = FakeFalcon::Step::kOff;
    return !f_.gone;
  }
  bool write(const std::uint8_t* bytes, std::size_t size, int) override {
    if (f_.gone) return false;
    const std::vector<std::uint8_t> said(bytes, bytes + size);
    switch (f_.step) {
      case FakeFalcon::Step::kOff:
        if (!f_.deaf && said == std::vector<std::uint8_t>{0x0a, 0x43, 0x0d}) {
          answer({0x0a, 0x44, 0x2c, 0x0d});
          f_.step = FakeFalcon::Step::kGreeted;
        }
        return true;
      case FakeFalcon::Step::kGreeted:
        if (said == std::vector<std::uint8_t>{0x41}) {
          answer({0x41});
          f_.step = FakeFalcon::Step::kLoading;
        }
        return true;
      case FakeFalcon::Step::kLoading:
        for (const std::uint8_t byte : said) {
          f_.out.push_back(f_.received.size() == f_.corrupt_at ? static_cast<std::uint8_t>(byte ^ 0x10)
                                                               : byte);
          f_.received.push_back(byte);
        }
        if (f_.received == f_.firmware) f_.step = FakeFalcon::Step::kRuns;
        return true;
      case FakeFalcon::Step::kRuns:
        return take_command(said);
    }
    return true;
  }
  int read(std::uint8_t* bytes, std::size_t most, int most_ms) override {
    if (f_.gone) return -1;
    if (f_.out.empty()) {
      f_.now_ns += 1'000'000LL * most_ms;
      return 0;
    }
    const std::size_t count = std::min({most, f_.out.size(), f_.chop});
    std::copy_n(f_.out.begin(), count, bytes);
    f_.out.erase(f_.out.begin(), f_.out.begin() + static_cast<std::ptrdiff_t>(count));
    return static_cast<int>(count);
  }
  std::string where() const override { return "Falcon (a fake)"; }

 private:
  void answer(const std::vector<std::uint8_t>& bytes) {
    f_.out.insert(f_.out.end(), bytes.begin(), bytes.end());
  }

  bool take_command(const std::vector<std::uint8_t>& said) {
    if (said.size() != kFalconPacket || said.front() != '<' || said.back() != '>') return true;
    FalconPacket packet{};
    std::copy(said.begin(), said.end(), packet.begin());
    f_.commands.push_back(packet);
    if (f_.silent) return true;
    // A millisecond from the command to its answer.
    f_.now_ns += 1'000'000;
    f_.grip += 0.001 * f_.velocity;
    if (f_.counts) f_.buttons = static_cast<std::uint8_t>((f_.buttons + 1) & 0x0f);
    bool reachable = false;
    const FalconAngles angles = falcon_angles(f_.grip, reachable);
    std::vector<std::uint8_t> report{'<'};
    for (const double angle : angles) {
      const auto bits = static_cast<std::uint16_t>(std::lround(falcon_count_of(angle)));
      for (int i = 0; i < 4; ++i)
        report.push_back(static_cast<std::uint8_t>(0x41 + ((bits >> (4 * i)) & 0xf)));
    }
    report.push_back(static_cast<std::uint8_t>(0x41 + (f_.buttons | (f_.homed ? 0x70 : 0x30))));
    report.push_back(0x41);
    report.push_back('>');
    answer(report);
    return true;
  }

  FakeFalcon& f_;
};

}  // namespace slosh::test
