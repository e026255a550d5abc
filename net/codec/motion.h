// Where a block's particles are expected next, from where they were in its last two frames. Integers alone:
// both ends must get bitwise identical results whatever machine and compiler they have.
#pragma once

#include <cstdint>

#include "net/codec/lattice.h"

namespace slosh::codec {

constexpr int kFine = 12;  ///< predictions are in lattice steps / 4096

/// Displacements from the newest frame on, lattice steps / 4096.
struct BlockMotion {
  std::int32_t smooth[3][kBlock];  ///< of the block's affine motion, fitted by least squares
  std::int32_t own[3][kBlock];     ///< the particle's own last one
};

/// `count` points of the last frame and the one before.
void fit_motion(const BlockPoints& last, const BlockPoints& before, int count, BlockMotion& out);

/// The same displacement for all: the frame after a key frame knows no velocities. `drift` in steps / 8.
void uniform_motion(const std::int32_t drift[3], int count, BlockMotion& out);

constexpr int kBlends = 4;
/// Blend b takes b quarters of the particle's own motion, the rest of the smooth one.
inline std::int32_t blend_motion(std::int32_t smooth, std::int32_t own, int blend) {
  return smooth + (((own - smooth) * blend) >> 2);
}

}  // namespace slosh::codec
