// Why a pose that a peer sent was not used.
#pragma once

#include <cstdint>

#include "sim/math/limits.h"

namespace slosh {

enum class PoseFault : std::uint8_t {
  kNone,
  kNonFinite,     ///< a NaN or an infinity
  kNotARotation,  ///< the quaternion's length is off 1 by more than 1 %
  kOutOfRange,    ///< farther outside the domain than kHandleReach
  kTooFast,       ///< a twist, or a jump since the last good pose, above the limits
};

/// For people, behind "your poses are not used: ".
inline const char* words_of(PoseFault fault) {
  switch (fault) {
    case PoseFault::kNonFinite:
      return "they are not finite numbers";
    case PoseFault::kNotARotation:
      return "their orientation is no rotation";
    case PoseFault::kOutOfRange:
      return "the device is more than 5 m outside the scene";
    case PoseFault::kTooFast:
      return "the device moves or jumps faster than 20 m/s or 100 rad/s";
    case PoseFault::kNone:
      break;
  }
  return "";
}

}  // namespace slosh
