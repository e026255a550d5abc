// What the engine brings back from the GPU when somebody asks for it: a saved world, a hash, sums, a picture.
#pragma once

#include "sim/cuda/device_particles.h"
#include "sim/cuda/host_particles.h"
#include "sim/cuda/wall_clamps.h"

namespace slosh::cuda {

/// `count` values, once all that the stream has to do is done; nothing after a failure.
template <class T>
void fetch(const T* from, T* to, std::size_t count, CallCheck& check, cudaStream_t stream) {
  if (check.failed() || count == 0 || !from) return;  // a pack that the plan does not need
  check.ok(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToHost, stream), "download");
  check.ok(cudaStreamSynchronize(stream), "download");
}

/// Empty after a failure.
inline HostPacks fetch_packs(const FluidBuffers& fluid, CallCheck& check, cudaStream_t stream) {
  HostPacks packs;
  if (check.failed()) return packs;
  for_each_pack(
      [&](auto, auto& values, const auto* from) {
        values.resize(fluid.count());
        fetch(from, values.data(), values.size(), check, stream);
      },
      packs, fluid.state());
  if (check.failed()) return {};
  return packs;
}

/// What bodies have still to be given by walls; zeros after a failure.
inline ImpulseSums fetch_impulses(const WallClamps& clamps, CallCheck& check, cudaStream_t stream) {
  ImpulseSums sums(clamps.impulses().size());
  fetch(clamps.impulses().data(), sums.data(), sums.size(), check, stream);
  return sums;
}

}  // namespace slosh::cuda
