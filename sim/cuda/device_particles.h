// The arrays of the CUDA backend, and the views of them that kernels take.
#pragma once

#include "sim/cuda/device_buffer.h"
#include "sim/cuda/kernels.h"

namespace slosh::cuda {

/// What a sort needs; shared by the sets, one after the other in a stream.
class SortSpace {
 public:
  void allocate(std::uint32_t largest_count, int bits, CallCheck& check);
  void sort(const std::uint32_t* keys, std::uint32_t* sorted_keys, std::uint32_t* order, std::uint32_t count,
            CallCheck& check, cudaStream_t stream);
  std::uint32_t* order() const { return order_.data(); }

 private:
  DeviceBuffer<std::uint32_t> identity_, order_;
  DeviceBuffer<unsigned char> temp_;
  int bits_ = 32;
};

class CellTableBuffers {
 public:
  void allocate(std::uint32_t cells, CallCheck& check);
  void clear(CallCheck& check, cudaStream_t stream);
  CellTable view() const { return {begin_.data(), end_.data()}; }

 private:
  DeviceBuffer<std::uint32_t> begin_, end_;
};

/// Fluid particles twice: sorted, and as the last step left them.
class FluidBuffers {
 public:
  void allocate(const ParticleStart& start, const RunConstants& constants, CallCheck& check);
  /// Brings the moved particles into the order of their cells.
  void sort(const StepConstants& constants, SortSpace& space, CallCheck& check, cudaStream_t stream);

  /// Replaces the moved particles; all spans have count() entries.
  void write_moved(std::span<const float4> x, std::span<const float4> v, std::span<const std::uint32_t> id,
                   std::span<const std::uint32_t> key, std::span<const std::uint8_t> kind, CallCheck& check,
                   cudaStream_t stream);
  /// Makes room for a viscosity a particle where the plan has come to need it.
  void allow_viscosities(const RunConstants& constants, CallCheck& check);

  std::uint32_t count() const { return count_; }
  const FluidView& moved() const { return moved_view_; }
  const SortedFluid& sorted() const { return sorted_view_; }

 private:
  struct Columns {
    DeviceBuffer<float4> x, v;
    DeviceBuffer<std::uint32_t> id, key;
    DeviceBuffer<std::uint8_t> kind;
    FluidView view() const { return {x.data(), v.data(), id.data(), kind.data(), key.data()}; }
  };
  std::uint32_t count_ = 0;
  Columns moved_, sorted_;
  DeviceBuffer<float4> pressed_;
  DeviceBuffer<float> viscosity_;
  CellTableBuffers cells_;
  FluidView moved_view_;
  SortedFluid sorted_view_;
};

/// The surface particles of all fixed or of all free bodies.
class SurfaceBuffers {
 public:
  void allocate(const std::vector<SurfaceParticle>& particles, const RunConstants& constants,
                CallCheck& check);
  void place(const StepConstants& constants, const DeviceBody* bodies, SortSpace& space, CallCheck& check,
             cudaStream_t stream);

  std::uint32_t count() const { return local_view_.count; }
  const LocalSurface& local() const { return local_view_; }
  const SortedSurface& sorted() const { return sorted_view_; }

 private:
  DeviceBuffer<float4> position_, placed_, velocity_, force_, sorted_x_, sorted_v_;
  DeviceBuffer<float2> material_;
  DeviceBuffer<float> viscosity_;
  DeviceBuffer<std::uint16_t> body_, sorted_body_;
  DeviceBuffer<std::uint32_t> key_, sorted_key_, order_;
  CellTableBuffers cells_;
  LocalSurface local_view_;
  SortedSurface sorted_view_;
};

}  // namespace slosh::cuda
