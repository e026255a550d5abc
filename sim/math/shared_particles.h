// Where a moment's particles lie in a GPU's memory, so that who draws on that GPU reads them there. Plain
// data: the one side needs no CUDA for it and the other no OpenGL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace slosh {

/// Valid, and what lies there stays as it is, while the shared_ptr that it came in is held: until the GPU has
/// read it.
struct SharedParticles {
  std::uint64_t allocation =
      0;                      ///< which allocation, unique in the process: to be opened once, not each time
  int descriptor = -1;        ///< of the allocation: a POSIX file descriptor that its owner closes
  std::size_t bytes = 0;      ///< of the allocation
  std::size_t positions = 0;  ///< byte where they begin, a multiple of 256: three floats a particle, m, world
  std::size_t fluids = 0;     ///< byte where they begin, likewise: a byte a particle, 255 = not drawn
  std::size_t count = 0;      ///< particles
  std::array<std::uint8_t, 16> device{};  ///< the GPU's UUID, as CUDA, Vulkan and OpenGL have it
};

}  // namespace slosh
