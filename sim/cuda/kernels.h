// The passes on the GPU as functions that launch them. Views are plain pointers into device memory; every
// launch goes to the given stream and returns at once.
//
// Columns are packed for 16-byte loads: a neighbour is one load in the density pass, two or three in the
// force pass.
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "sim/columns.h"
#include "sim/passes/body_drag/body_drag.h"
#include "sim/run_constants.h"
#include "sim/walls/penetration_clamp.h"
#include "sim/walls/surface_motion.h"

namespace slosh::cuda {

/// RunConstants as the kernels need it.
struct StepConstants {
  CellGrid grid;  ///< the world's, sliced
  float support_radius = 0.0f;
  std::int32_t coarse_reach_squared = 0;  ///< CellGrid's, of that
  float force_scale = 0.0f;
  DragShape<float> drag_shape{1.0f, 0.0f};
  float rest_number_density = 0.0f;
  float rest_volume = 0.0f;
  float stiffness = 0.0f;
  float tension = 0.0f;
  glm::vec3 gravity{0.0f};
  CorrectionConstants correction;
};

/// Whether the thread's GPU can bring a kernel up while the one before it ends (programmatic dependent
/// launch): up to a tenth of a step of small kernels.
inline bool launches_early() {
  int gpu = 0, major = 0;
  return cudaGetDevice(&gpu) == cudaSuccess &&
         cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, gpu) == cudaSuccess && major >= 9;
}

/// Up to how many particles teams of four threads and of two are quickest; measured on an H200
/// (tests/bench/results/2026-11-cuda-teams-h200.csv).
struct TeamSizes {
  std::uint32_t four, two;
  constexpr std::uint32_t lanes(std::uint32_t count) const {
    return count <= four ? 4 : count <= two ? 2 : 1;
  }
};
/// Of the corrected model, whose pairs take more work, and of bodies' particles.
inline constexpr TeamSizes kTensorTeams{60'000, 0};
inline constexpr TeamSizes kDensityTeams{50'000, 100'000};
inline constexpr TeamSizes kForceTeams{100'000, 700'000};

/// A grid's cells in tiles of some thousand, each of whole lines along x: fluid fills a small part of most
/// domains, and a sort looks at those tiles alone that have particles.
struct CellTiles {
  explicit CellTiles(const CellGrid& grid)
      : cells(grid.line_cells() * std::max(1u, kAbout / grid.line_cells())),
        count((grid.cell_count() + cells - 1) / cells) {}
  static constexpr std::uint32_t kAbout = 4096;

  std::uint32_t cells;  ///< of a tile; the last one may have fewer
  std::uint32_t count;  ///< of tiles
};

/// Where each cell's particles begin in sorted order; the next cell's of its line begin where they end. One
/// more than cells: the last says where those begin that are out of the domain. All of a tile without
/// particles have one value, whichever.
struct CellTable {
  std::uint32_t* start = nullptr;
  std::uint8_t* filled = nullptr;  ///< 1: a tile whose values differ
};

/// A counting sort under way. Its order is that of cells and, within a cell, of before: tickets are given to
/// whoever comes first, so a particle's place in its cell is how many of its cell's came from before it.
struct SortView {
  static constexpr std::uint32_t kStays = 0xffffffffu;  ///< the ticket of who was out already

  std::uint32_t* counts = nullptr;      ///< of each key; 0 before and after a sort
  std::uint32_t* in_tile = nullptr;     ///< of each tile; 0 before and after
  std::uint32_t* tile_start = nullptr;  ///< where each tile begins, and behind them the last one's end
  std::uint32_t* tickets = nullptr;     ///< of each particle, within its key
  std::uint32_t* came = nullptr;        ///< where from, in the order of keys and tickets
  std::uint32_t tile_cells = 1;
};

/// The packs of sim/columns.h that outlive a step: `Store` is a buffer, a pointer or a vector.
template <template <class> class Store>
struct MovingPacks {
  Store<float4> x{};           ///< position, m; w is not used
  Store<float4> v{};           ///< velocity, m/s, half a step behind x; w: volume, m³, from the density pass
  Store<std::uint32_t> id{};   ///< fixed for the run
  Store<std::uint8_t> kind{};  ///< into the table of kinds
  Store<float> solved{};       ///< Pa, that the last step found; there only with pressure projection
  Store<float4> heat{};        ///< temperature, cure, from_bodies, thickness; there only with kHeat
  Store<std::uint32_t> key{};  ///< cell, or retired
};

/// Calls f(pack, set.pack…) for each of them; the pack is a constant.
template <class F, class... Sets>
SLOSH_HD void for_each_pack(F&& f, Sets&&... sets) {
  f(std::integral_constant<Pack, Pack::kPosition>{}, sets.x...);
  f(std::integral_constant<Pack, Pack::kMotion>{}, sets.v...);
  f(std::integral_constant<Pack, Pack::kId>{}, sets.id...);
  f(std::integral_constant<Pack, Pack::kKind>{}, sets.kind...);
  f(std::integral_constant<Pack, Pack::kSolved>{}, sets.solved...);
  f(std::integral_constant<Pack, Pack::kHeat>{}, sets.heat...);
  f(std::integral_constant<Pack, Pack::kKey>{}, sets.key...);
}

/// Which plans have a pack: those that need its columns.
constexpr ColumnNeed need_of(Pack pack) {
  for (const ColumnInfo& column : kFluidColumns) {
    if (column.pack == pack) return column.need;
  }
  return ColumnNeed::kAlways;
}
/// Whether a sort gathers a pack: when it carries one of its columns.
constexpr bool carried(Pack pack) {
  for (const ColumnInfo& column : kFluidColumns) {
    if (column.pack == pack && column.life == ColumnLife::kCarried) return true;
  }
  return false;
}
/// Every column that outlives a step is in one of the packs above.
constexpr bool packs_hold_every_column() {
  for (const ColumnInfo& column : kFluidColumns) {
    if (column.life != ColumnLife::kStep && column.pack > Pack::kKey && column.pack != Pack::kNone)
      return false;
  }
  return true;
}
static_assert(packs_hold_every_column());

template <class T>
using DevicePointer = T*;

/// Fluid particles (and probes) in some order.
using FluidView = MovingPacks<DevicePointer>;

/// The fluid that each thread of the density pass found near, some of it a little out of reach, for the force
/// pass's thread of the same particle. Four entries of each of a warp's 32 threads are one run of memory.
struct NearLists {
  std::uint32_t room = 0;    ///< entries a thread, a multiple of kListed; who has more walks the cells anew
  uint4* entries = nullptr;  ///< kListed each
  std::uint32_t* counts = nullptr;  ///< entries, a multiple of kListed, written down or not

  SLOSH_HD uint4* of(std::uint32_t thread) const {
    return entries + (std::size_t{thread / 32} * (room / 4) * 32 + thread % 32);
  }
};
/// Entries that are read at a time; lists are filled up to a multiple.
inline constexpr std::uint32_t kListed = 4;

/// Entries behind the last particle's of what is read of neighbours: zero, and far from everywhere, so that a
/// kernel may read beyond a row, and lists be filled up to a multiple of four.
inline constexpr std::uint32_t kNobodies = 16;

/// Sorted fluid with what the passes of a step add.
struct SortedFluid {
  std::uint32_t count = 0;  ///< retired ones, at the end, included
  FluidView state;
  std::uint32_t* coarse = nullptr;  ///< CellGrid::coarse_of(), from the sort; not of kPaper
  float4* pressed = nullptr;        ///< position, and in w the pressure (corrects_gradients(): the volume)
  float4* push_a =
      nullptr;  ///< kCorrected: xx, xy, xz, yy of the pressure tensor, N·m⁴; kIncompressible: of 1 Pa's
  float4* push_b = nullptr;    ///< kCorrected: yz, zz of it; x, y of viscosity times velocity, Pa·m
  float* drag_z = nullptr;     ///< kCorrected: z of that
  float* expansion = nullptr;  ///< kIncompressible: wanted ρ⁰/ρ − 1
  float* viscosity = nullptr;  ///< Pa·s; there and written only where pairs differ
  // kFluidStress:
  float4* passed_x = nullptr;  ///< the rows of each one's pressure and stress tensor (kCorrected),
  float4* passed_y = nullptr;  ///< N·m⁴; in w viscosity times velocity, Pa·m
  float4* passed_z = nullptr;
  float* left = nullptr;      ///< viscosity for Eq 9 with fluid, Pa·s
  float2* heating = nullptr;  ///< kHeat: W, and what of it is by bodies
  float4* force = nullptr;    ///< N; w: 1 where bodies are in the cells around, else 0
  CellTable cells;
  NearLists near;  ///< not of kPaper
};

/// Body particles as they stay for the run, in local order: body by body.
struct LocalSurface {
  std::uint32_t count = 0;
  const float4* position = nullptr;  ///< mesh frame, m; w: pressure or share
  const float2* material = nullptr;  ///< volume m³, viscosity Pa·s
  const float* reach = nullptr;      ///< m, SurfaceParticle::reach
  const std::uint16_t* body = nullptr;
  float4* placed = nullptr;      ///< world, m, local order; w as in `position`
  float4* velocity = nullptr;    ///< world, m/s, local order; w: volume
  std::uint32_t* key = nullptr;  ///< local order
  float4* force = nullptr;       ///< by the fluid, N, local order
  float4* couple = nullptr;      ///< what turns the body besides the force's moment, N·m, local order
  float4* drag_a = nullptr;      ///< kBodyDrag: xx, xy, xz, yy of what the force loses for each m/s, N·s/m
  float2* drag_b = nullptr;      ///< yz, zz of it
};

/// A MirrorPlane a particle (walls/mirror_planes.h), in local order; null where no body of a set mirrors.
struct MirrorPlanes {
  const float4* normal = nullptr;  ///< w is not used
  const float4* bend_a = nullptr;  ///< xx, xy, xz, yy
  const float2* bend_b = nullptr;  ///< yz, zz
};

/// Body particles sorted by cell.
struct SortedSurface {
  std::uint32_t count = 0;
  float4* x = nullptr;  ///< world; w: pressure or share
  float4* v = nullptr;  ///< w: volume
  float* viscosity = nullptr;
  float* reach = nullptr;  ///< m
  std::uint16_t* body = nullptr;
  std::uint32_t* key = nullptr;
  std::uint32_t* order = nullptr;  ///< local index of each
  CellTable cells;
  MirrorPlanes mirror;
};

/// A body's motion for a step.
struct DeviceBody {
  SurfaceMotion motion;
  glm::dvec3 position{0.0};  ///< of the centre of mass, m, world
};

/// A body of the penetration clamp in a sub-step.
struct DeviceClamp {
  ClampBody body;
  BoundingSphere sphere;
  glm::dvec3 center{0.0};  ///< of mass as the sub-step ends, m, world
  std::uint32_t number{};  ///< index into Scene::bodies
};

/// A probe's state for a step.
struct DeviceProbe {
  float4 x, v;
};

/// Particles [begin, end) of a body, in local order, that one block sums.
struct WrenchChunk {
  std::uint32_t begin = 0, end = 0;
  std::uint32_t body = 0;
  std::uint32_t moving = 0;  ///< 1: of the free bodies' particles, 0: of the fixed ones'
  std::uint32_t range = 0;   ///< the chunks of its body
};

/// The chunks of one body.
struct WrenchRange {
  std::uint32_t begin = 0, end = 0;
};

/// How the sums over the bodies' particles are cut, and room for their parts.
struct SumPlan {
  static constexpr int kWrench = 6, kAll = kWrench + BodyDrag::kSize;  ///< numbers of a part

  const WrenchChunk* chunks = nullptr;
  std::uint32_t chunk_count = 0;  ///< > 0
  const WrenchRange* ranges = nullptr;
  double* partial = nullptr;      ///< kAll a chunk: a wrench and a drag
  std::uint32_t* done = nullptr;  ///< chunks, of each range; 0 before and after
};

struct DeviceWrench {
  double force[3] = {};
  double torque[3] = {};

  Wrench wrench() const { return {{force[0], force[1], force[2]}, {torque[0], torque[1], torque[2]}}; }
};

/// order.cu. Counts keys and gives tickets; who was out already, at `*out_before` and behind, stays.
/// `out_before`: null where nobody was.
void launch_count_keys(const std::uint32_t* keys, std::uint32_t count, std::uint32_t retired,
                       const std::uint32_t* out_before, const SortView& sort, cudaStream_t stream);
/// Where each cell begins, by the counts, to `cells`; then notes who of `count` came from where.
void launch_find_cells(const std::uint32_t* keys, std::uint32_t count, std::uint32_t retired,
                       const CellTiles& tiles, const SortView& sort, const CellTable& cells,
                       cudaStream_t stream);
/// Each to its place; the counts become 0 again.
void launch_gather_fluid(const StepConstants& constants, const FluidView& from, const SortView& sort,
                         const SortedFluid& to, cudaStream_t stream);
/// Where the bodies' motions take them, their keys, counted for `sort`.
void launch_place_surface(const StepConstants& constants, const LocalSurface& local, const DeviceBody* bodies,
                          const SortView& sort, cudaStream_t stream);
void launch_gather_surface(const StepConstants& constants, const LocalSurface& from, const SortView& sort,
                           const SortedSurface& to, cudaStream_t stream);
void launch_carry_probes(const StepConstants& constants, const DeviceProbe* probes,
                         const std::uint32_t* slots, std::uint32_t count, const FluidView& fluid,
                         cudaStream_t stream);
void launch_damp(float4* velocities, std::uint32_t count, float keep, cudaStream_t stream);
/// By id; retired ones get kind 255.
void launch_scatter(const StepConstants& constants, const FluidView& fluid, std::uint32_t count,
                    std::uint32_t visible, float* positions, std::uint8_t* kinds, cudaStream_t stream);

/// density.cu: Eq 2 and 7. `artificial`: any_artificial_viscosity.
void launch_density(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                    bool artificial, const SortedFluid& fluid, const SortedSurface& fixed,
                    const SortedSurface& moving, std::uint32_t* status, cudaStream_t stream);

/// What kHeat takes besides the particles.
struct HeatView {
  const HeatKind* kinds = nullptr;
  const float* bodies = nullptr;               ///< °C, one a body
  float pair_scale = 0.0f, wall_scale = 0.0f;  ///< HeatConstants'; the second for each unit of a wall's share
  bool by_volume = false;                      ///< that share is its volume
};
/// passes/heat/cuda.cu: what each gets from its neighbours over `dt` s, and with it its thickness; with no
/// time that alone.
void launch_heat(const StepConstants& constants, const ParticleKind* kinds, const HeatView& heat, float dt,
                 const SortedFluid& fluid, const SortedSurface& fixed, const SortedSurface& moving,
                 cudaStream_t stream);

/// force.cu: Eq 5, 6 and 9 on fluid particles, to fluid.force.
void launch_force(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                  const SortedFluid& fluid, const SortedSurface& fixed, const SortedSurface& moving,
                  cudaStream_t stream);

/// Where a probe's force goes, and where in the order it is; both by id less `first`.
struct ProbeOutput {
  std::uint32_t first = 0;
  float4* forces = nullptr;
  std::uint32_t* slots = nullptr;
};
/// The bodies of the penetration clamp in a sub-step, and what it takes from particles.
struct ClampView {
  std::uint32_t count = 0;  ///< of bodies that there are; 0: no clamp
  std::uint32_t all = 0;    ///< of the scene's bodies, each of which has its place in `impulses`
  std::uint32_t any_fast = 0;
  const DeviceClamp* bodies = nullptr;
  unsigned long long* impulses = nullptr;  ///< as ImpulseSums; added to
  ImpulseUnits units;
};
/// integrate.cu: out[i] = impulses[i], impulses[i] = 0.
void launch_hand_over(std::int64_t* impulses, std::int64_t* out, std::size_t words, cudaStream_t stream);
/// integrate.cu: the leap-frog over `dt` s, in place, no further than to the walls, with the new keys,
/// counted for `sort` unless that is empty. Probes stay where they are.
void launch_integrate(const StepConstants& constants, const ParticleKind* kinds, const SortedFluid& fluid,
                      float dt, float max_speed, const ClampView& clamps, const ProbeOutput& probes,
                      const SortView& sort, std::uint32_t* status, cudaStream_t stream);

/// wrench.cu: Eq 5, 6 and 9 on the particles of `surface` whose body is wanted, to `local`'s force and,
/// `with_drag`, to its drag.
void launch_surface_forces(const StepConstants& constants, const Plan& plan, float first_viscosity,
                           const SortedFluid& fluid, const SortedSurface& surface, const std::uint8_t* wanted,
                           const LocalSurface& local, bool with_drag, cudaStream_t stream);
/// Eq 10–12 and the drag of the free bodies, the others' being zero: either null where it is not asked for.
/// Summed in double in a fixed shape: chunk by chunk, then body by body.
void launch_sums(const LocalSurface& fixed, const LocalSurface& moving, const DeviceBody* bodies,
                 const SumPlan& plan, DeviceWrench* wrenches, BodyDrag* drags, cudaStream_t stream);

/// drag.cu: adds to fluid.force the drag of `moving` by the velocities of `twists` (one a body); its own are
/// lost.
void launch_drag(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                 const SortedFluid& fluid, const SortedSurface& moving, const DeviceBody* twists,
                 cudaStream_t stream);

}  // namespace slosh::cuda
