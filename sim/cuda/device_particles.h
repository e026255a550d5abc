// The arrays of the CUDA backend, and the views of them that kernels take.
#pragma once

#include "sim/cuda/device_buffer.h"
#include "sim/cuda/kernels.h"

namespace slosh::cuda {

/// Of a cell across x.
inline constexpr std::uint32_t kSlices = 4;

/// What of them the kernels need.
StepConstants step_constants(const RunConstants& constants);

/// A set's table of cells.
class CellStarts {
 public:
  void allocate(const CellGrid& grid, CallCheck& check);
  CellTable view() const { return {starts_.data(), filled_.data()}; }

 private:
  DeviceBuffer<std::uint32_t> starts_;
  DeviceBuffer<std::uint8_t> filled_;
};

/// What a counting sort by cell needs; shared by the sets, one after the other in a stream.
class SortSpace {
 public:
  void allocate(std::uint32_t largest_count, const CellGrid& grid, CallCheck& check);
  /// Counts the keys. `some_out`: `cells` is of the sort before, whose last particles are out.
  void count_keys(const std::uint32_t* keys, std::uint32_t count, bool some_out, CellTable cells,
                  cudaStream_t stream) const;
  /// Where each cell will begin, by the counts to `cells`; what is left is to bring each to its place.
  void find_cells(const std::uint32_t* keys, std::uint32_t count, CellTable cells, CallCheck& check,
                  cudaStream_t stream);
  SortView view() const {
    return {counts_.data(), in_tile_.data(), tile_start_.data(), tickets_.data(), came_.data(), tiles_.cells};
  }

 private:
  DeviceBuffer<std::uint32_t> counts_, in_tile_, tile_start_, tickets_, came_;
  CellTiles tiles_{CellGrid()};
  std::uint32_t retired_ = 0;
};

/// Whether SortSpace has the keys' counts already.
enum class Keys { kCounted, kNotCounted };

/// Fluid particles, and a second set of packs that a sort gathers to.
class FluidBuffers {
 public:
  /// `grid`: StepConstants::grid.
  void allocate(std::size_t count, const RunConstants& constants, const CellGrid& grid, CallCheck& check);
  /// Brings the particles into the order of their cells.
  void sort(const StepConstants& constants, SortSpace& space, Keys keys, CallCheck& check,
            cudaStream_t stream);

  /// Replaces the particles; all packs have count() entries.
  void write(const MovingPacks<PlainColumn>& packs, CallCheck& check, cudaStream_t stream);
  /// Makes room for a viscosity a particle where the plan has come to need it.
  void allow_viscosities(const RunConstants& constants, CallCheck& check);

  std::uint32_t count() const { return view_.count; }
  /// The particles in whichever order they are.
  const FluidView& state() const { return view_.state; }
  const SortedFluid& sorted() const { return view_; }

 private:
  MovingPacks<DeviceBuffer> packs_[2];
  int current_ = 0;
  DeviceBuffer<float4> pressed_, force_;
  DeviceBuffer<float> viscosity_;
  DeviceBuffer<float4> push_a_, push_b_;
  DeviceBuffer<float> drag_z_, expansion_;
  DeviceBuffer<float4> passed_x_, passed_y_, passed_z_;  // kFluidStress
  DeviceBuffer<float> left_;                             // kFluidStress
  DeviceBuffer<float2> heating_;                         // kHeat
  CellStarts starts_;
  DeviceBuffer<std::uint32_t> coarse_, near_counts_;
  DeviceBuffer<uint4> near_;
  bool some_out_ = false;  // since write(), these are sorted
  SortedFluid view_;
};

/// The surface particles of all fixed or of all free bodies.
class SurfaceBuffers {
 public:
  void allocate(const std::vector<SurfaceParticle>& particles, const CellGrid& grid, CallCheck& check);
  void place(const StepConstants& constants, const DeviceBody* bodies, SortSpace& space, CallCheck& check,
             cudaStream_t stream);
  /// Other particles from place `first` on, of the same body.
  void replace(std::size_t first, std::span<const SurfaceParticle> particles, CallCheck& check,
               cudaStream_t stream);

  std::uint32_t count() const { return local_view_.count; }
  const LocalSurface& local() const { return local_view_; }
  const SortedSurface& sorted() const { return sorted_view_; }

 private:
  MirrorPlanes upload_mirrors(const std::vector<SurfaceParticle>& particles, CallCheck& check);

  DeviceBuffer<float4> position_, placed_, velocity_, force_, couple_, sorted_x_, sorted_v_;
  DeviceBuffer<float2> material_;
  DeviceBuffer<float4> drag_a_;  // kBodyDrag
  DeviceBuffer<float2> drag_b_;
  DeviceBuffer<float4> mirror_normal_, mirror_bend_a_;  // where a body mirrors
  DeviceBuffer<float2> mirror_bend_b_;
  DeviceBuffer<float> viscosity_, reach_, sorted_reach_;
  DeviceBuffer<std::uint16_t> body_, sorted_body_;
  DeviceBuffer<std::uint32_t> key_, sorted_key_, order_;
  CellStarts starts_;
  LocalSurface local_view_;
  SortedSurface sorted_view_;
};

}  // namespace slosh::cuda
