// Bonds as the CPU has them.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/passes/bonds/bonds.h"

namespace slosh {

struct CpuBonds {
  static constexpr std::uint32_t kNowhere = 0xffffffffu;
  BondTable table;                     ///< empty without kBonds
  std::vector<std::uint32_t> slot_of;  ///< by id; kNowhere: out of the world
  std::vector<std::uint8_t> is_new;    ///< by id: 1: it has set since the last look; 2: it got bonds
};

}  // namespace slosh
