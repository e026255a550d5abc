// Bonds as a GPU has them.
#pragma once

#include "sim/cuda/device_buffer.h"
#include "sim/cuda/kernels.h"
#include "sim/passes/bonds/bonds.h"

namespace slosh::cuda {

/// By id.
struct BondView {
  Bond* bonds = nullptr;  ///< rows of kMaxBonds
  std::uint8_t* count = nullptr;
  std::uint8_t* set = nullptr;
  float* weight = nullptr;
  std::uint8_t* is_new = nullptr;    ///< it has set since the last look
  std::uint8_t* grew = nullptr;      ///< it got bonds at that
  std::uint32_t* kept = nullptr;     ///< a bit for each of a row
  std::uint32_t* slot_of = nullptr;  ///< all ones: out of the world
};

class BondBuffers {
 public:
  void allocate(std::size_t particles, CallCheck& check) {
    bonds_.allocate(particles * kMaxBonds, check);
    for (DeviceBuffer<std::uint8_t>* bytes : {&count_, &set_, &is_new_, &grew_})
      bytes->allocate(particles, check);
    weight_.allocate(particles, check);
    kept_.allocate(particles, check);
    slot_of_.allocate(particles, check);
  }
  void write(const BondTable& table, CallCheck& check, cudaStream_t stream) {
    bonds_.write(table.bonds, check, stream);
    count_.write(table.count, check, stream);
    set_.write(table.set, check, stream);
    weight_.write(table.weight, check, stream);
  }
  BondView view() const {
    return {bonds_.data(),  count_.data(), set_.data(),  weight_.data(),
            is_new_.data(), grew_.data(),  kept_.data(), slot_of_.data()};
  }

 private:
  DeviceBuffer<Bond> bonds_;
  DeviceBuffer<std::uint8_t> count_, set_, is_new_, grew_;
  DeviceBuffer<float> weight_;
  DeviceBuffer<std::uint32_t> kept_, slot_of_;
};

/// passes/bonds/cuda.cu: adds the bonds' forces to fluid.force. `look`: who has set and who melted since the
/// last time is found first, and who sets is bound to what has set within `reach`, m; `whole`:
/// bond_lengths().
void launch_bonds(const StepConstants& constants, const HeatKind* kinds, bool look, float reach, float whole,
                  const SortedFluid& fluid, const BondView& bonds, cudaStream_t stream);

}  // namespace slosh::cuda
