#include "sim/passes/wrenches/cuda_sums.h"

#include <algorithm>

namespace slosh::cuda {

namespace {

/// Body particles that one block sums, of a body of `count`: so few chunks that their sum costs little.
std::uint32_t chunk_of(std::uint32_t count) {
  constexpr std::uint32_t kFewest = 256, kMaxChunks = 128;
  return std::max(kFewest, (count + kMaxChunks - 1) / kMaxChunks);
}

}  // namespace

void WrenchSums::plan(const Plan& plan, const ParticleStart& start, std::size_t body_count,
                      CallCheck& check) {
  std::vector<std::uint8_t> wanted(body_count, 0);
  for (const int b : plan.wrench_bodies) wanted[b] = 1;
  std::vector<WrenchChunk> chunks;
  std::vector<WrenchRange> ranges;
  const auto cut = [&](const std::vector<SurfaceParticle>& particles, bool moving) {
    const std::uint32_t count = static_cast<std::uint32_t>(particles.size());
    for (std::uint32_t begin = 0; begin < count;) {
      const std::uint16_t body = particles[begin].body;
      std::uint32_t end = begin;
      while (end < count && particles[end].body == body) ++end;
      if (wanted[body]) {
        const std::uint32_t first = static_cast<std::uint32_t>(chunks.size());
        const std::uint32_t chunk = chunk_of(end - begin), range = static_cast<std::uint32_t>(ranges.size());
        for (std::uint32_t i = begin; i < end; i += chunk)
          chunks.push_back({i, std::min(i + chunk, end), body, moving ? 1u : 0u, range});
        ranges.push_back({first, static_cast<std::uint32_t>(chunks.size())});
        summed_.push_back(body);
        (moving ? moving_measured_ : fixed_measured_) = true;
      }
      begin = end;
    }
  };
  if (plan.has(PassId::kWrenches)) {
    cut(start.moving, true);
    cut(start.fixed, false);
  }
  wanted_.upload(wanted, check);
  chunks_.upload(chunks, check);
  ranges_.upload(ranges, check);
  partial_.allocate(chunks.size() * SumPlan::kAll, check);
  done_.allocate(ranges.size(), check);
}

void WrenchSums::find_forces(const StepConstants& constants, const Plan& plan, float first_viscosity,
                             const SortedFluid& fluid, const SurfaceSides& sides, bool with_drag,
                             CallCheck& check, cudaStream_t stream) const {
  if (check.failed()) return;
  const auto find = [&](const SurfaceBuffers& surface, bool drag) {
    launch_surface_forces(constants, plan, first_viscosity, fluid, surface.sorted(), wanted_.data(),
                          surface.local(), drag, stream);
    check.launched("forces on bodies");
  };
  if (moving_measured_) find(sides.moving, with_drag);
  if (fixed_measured_ && !plan.has(PassId::kPressureSolve)) find(sides.fixed, false);
}

void WrenchSums::sum(const SurfaceSides& sides, const DeviceBody* bodies, DeviceWrench* wrenches,
                     BodyDrag* drags, CallCheck& check, cudaStream_t stream) const {
  if (summed_.empty() || check.failed()) return;
  const SumPlan plan{chunks_.data(), static_cast<std::uint32_t>(chunks_.size()), ranges_.data(),
                     partial_.data(), done_.data()};
  launch_sums(sides.fixed.local(), sides.moving.local(), bodies, plan, wrenches, drags, stream);
  check.launched("sums over bodies");
}

}  // namespace slosh::cuda
