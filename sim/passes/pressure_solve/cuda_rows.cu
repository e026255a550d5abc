// Writes the pressure pairs down.
#include "sim/passes/pressure_solve/cuda_pairs.cuh"

namespace slosh::cuda {

namespace {

// Writes one thread's row.
class RowWriter {
 public:
  __device__ RowWriter(const PressRows& rows, std::uint32_t thread)
      : room_(rows.room),
        by_own_(rows.by_own + rows.at(thread)),
        by_other_(rows.by_other + rows.at(thread)) {}

  __device__ void write(std::uint32_t j, const PressPair& pair) {
    if (count_ == 0) first_ = last_ = j;
    for (; j - last_ > kFarthest; last_ += kFarthest) nobody(kFarthest);
    put(entry_of(pair.by_own, j - last_), entry_of(pair.by_other, j - last_));
    last_ = j;
  }
  /// Fills the row up; its head.
  __device__ uint2 finish() {
    while (count_ % kListed != 0) nobody(0);
    return make_uint2(first_, count_);
  }

 private:
  static constexpr std::uint32_t kFarthest = 0xffff;

  __device__ void nobody(std::uint32_t on) {
    const uint2 entry = entry_of(make_float3(0.0f, 0.0f, 0.0f), on);
    put(entry, entry);
  }
  // Two at a time.
  __device__ void put(const uint2& own, const uint2& other) {
    if (count_++ % 2 == 0) {
      own_ = own;
      other_ = other;
      return;
    }
    if (count_ <= room_) {
      *by_own_ = make_uint4(own_.x, own_.y, own.x, own.y);
      *by_other_ = make_uint4(other_.x, other_.y, other.x, other.y);
    }
    by_own_ += 32;
    by_other_ += 32;
  }

  std::uint32_t room_;
  uint4 *by_own_, *by_other_;
  uint2 own_, other_;
  std::uint32_t count_ = 0, first_ = 0, last_ = 0;
};

template <class Team>
__global__ __launch_bounds__(kThreads, kBlocksOfTensors) void press_rows_kernel(
    StepConstants c, const ParticleKind* kinds, SortedFluid fluid, SortedSurface fixed, SortedSurface moving,
    PressureView view) {
  const std::uint32_t p = Team::particle();
  if (p >= view.fluid) return;
  const std::uint32_t cell = fluid.state.key[p];
  if (cell >= c.grid.retired_key()) {
    view.rows.heads[thread_index()] = make_uint2(0, 0);
    if (Team::lane() == 0) {
      view.own[p] = make_float4(0.0f, 0.0f, 0.0f, 0.0f);
      view.scale[p] = make_float2(0.0f, 0.0f);
    }
    return;
  }
  const PushTensor own = push_tensor(c, fluid, p);
  const float4 x = fluid.pressed[p];
  float3 push = make_float3(0.0f, 0.0f, 0.0f), walls = push, force = push;
  float squares = 0.0f;  // of pushes by fluid, over each neighbour's mass
  RowWriter row(view.rows, thread_index());
  for_listed<Team>(c.grid, fluid, cell, fluid.near.counts[thread_index()], [&](std::uint32_t j) {
    const PressPair pair = press_pair(c, fluid, x, own, j);
    const ParticleKind& kind = kinds[fluid.state.kind[j]];
    add(pair.by_own, 1.0f, push);
    add(pair.by_other, pair.unit * __ldg(fluid.state.solved + j), force);
    squares += kind.probe ? 0.0f : dot(pair.by_own, pair.by_own) / kind.mass;
    if (pair.meets) row.write(j, pair);
  });
  view.rows.heads[thread_index()] = row.finish();
  const auto add_walls = [&](const SortedSurface& surface) {
    if (surface.count == 0) return;
    for_each_wall<Team>(c, fluid, surface, p, [&](std::uint32_t, const float3& w) { add(w, 1.0f, walls); });
  };
  add_walls(fixed);
  add_walls(moving);
  add(pushed_by(own.k, walls), 1.0f, push);
  Team::sum(push.x, push.y, push.z, force.x, force.y, force.z, squares);
  if (Team::lane() != 0) return;
  view.own[p] = make_float4(push.x, push.y, push.z, own.unit);
  view.scale[p] = make_float2(own.unit * own.unit * squares, own.unit);
  add(push, own.unit * fluid.state.solved[p], force);
  add_force(fluid, p, force);
}

// Those with bodies that may move: of the fluid, and of the bodies' particles.
__global__ __launch_bounds__(kThreads) void touch_rows_kernel(StepConstants c, SortedFluid fluid,
                                                              SortedSurface moving, PressureView view) {
  const std::uint32_t e = thread_index();
  std::uint32_t count = 0;
  const auto write = [&](const PairRows& rows, std::uint32_t entry) {
    return [&rows, entry, &count](std::uint32_t other, const float3& push) {
      if (count < rows.room)
        rows.pairs[rows.at(entry, count)] = make_float4(push.x, push.y, push.z, __uint_as_float(other));
      ++count;
    };
  };
  if (e < view.fluid) {
    if (fluid.state.key[e] < c.grid.retired_key())
      for_each_walked_touch<Alone>(c, fluid, moving, e, write(view.touches, e));
    view.touches.counts[e] = count;
  } else if (e < view.fluid + view.surface) {
    const std::uint32_t i = e - view.fluid;
    for_each_walked_press(c, fluid, moving, i, write(view.presses, i));
    view.presses.counts[i] = count;
  }
}

}  // namespace

void launch_pressure_rows(const StepConstants& constants, const ParticleKind* kinds, const SortedFluid& fluid,
                          const SortedSurface& fixed, const SortedSurface& moving, const PressureView& view,
                          cudaStream_t stream) {
  with_team<kTensorTeams>(view.fluid, [&]<class Team>() {
    press_rows_kernel<Team><<<blocks_for(view.fluid * Team::kLanes), kThreads, 0, stream>>>(
        constants, kinds, fluid, fixed, moving, view);
  });
  if (view.surface == 0) return;
  touch_rows_kernel<<<blocks_for(view.fluid + view.surface), kThreads, 0, stream>>>(constants, fluid, moving,
                                                                                    view);
}

}  // namespace slosh::cuda
