#include "sim/snapshot.h"

#include <array>
#include <utility>

namespace slosh {

std::string status_text(std::uint32_t status) {
  static constexpr std::array<std::pair<StatusBit, const char*>, 11> kWords{{
      {kStatusNonFinite, "a particle or body became non-finite and was put out of the world"},
      {kStatusEscaped, "fluid left the domain and is out of the world"},
      {kStatusSpeedLimited, "particles were too fast and were slowed"},
      {kStatusInputRejected, "a handle's pose was not usable and the last good one was kept"},
      {kStatusForceLimited, "a device's force met its limit"},
      {kStatusTimeSlipped, "the simulation did not keep real time"},
      {kStatusCompressed,
       "fluid is squeezed to twice its density: stiffness_m2_s2 100 to 400 held in trials"},
      {kStatusDeviceLost, "the GPU failed and the fluid stands still: run again with the CPU backend"},
      {kStatusClamped,
       "penetration clamp: fluid was pressed at a wall so hard that particles were held back"},
      {kStatusViscosityCut, "implicit viscosity did not converge: the fluid is too viscous for its step"},
      {kStatusBodyGone, "a body left the world for good and was taken out of the motion"},
  }};
  std::string text;
  for (const auto& [bit, words] : kWords) {
    if (!(status & bit)) continue;
    if (!text.empty()) text += "; ";
    text += words;
  }
  return text;
}

}  // namespace slosh
