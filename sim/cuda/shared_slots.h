// Places on the GPU that particles are put into for who draws there: memory that CUDA exports, so that
// another interface of the driver opens it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "sim/math/result.h"
#include "sim/math/shared_particles.h"

namespace slosh::cuda {

class SharedSlots {
 public:
  struct Slot {
    float* positions = nullptr;     ///< three a particle
    std::uint8_t* kinds = nullptr;  ///< one a particle
    std::shared_ptr<const SharedParticles> particles;
  };

  /// Room for six times `count` particles. Errors: a driver that does not export memory, or has none left.
  Result<bool> start(std::size_t count);
  /// A place that nobody looks at, whose particles are null where there is none, or before start(). It is
  /// somebody's until the last copy of them goes, on whichever thread, this object's end or not.
  Slot take() const;

 private:
  struct Memory;
  std::shared_ptr<Memory> memory_;
};

}  // namespace slosh::cuda
