// The columns of the fluid's particles, in one table: memory, sorting, saving and the fingerprint of a run
// walk over it on both backends. A new column is one row here and whoever writes and reads it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace slosh {

/// How a column comes into the order of the cells.
enum class ColumnLife : std::uint8_t {
  kCarried,  ///< every sort gathers it
  kKey,      ///< what is sorted by: the sort itself leaves it in order
  kStep,     ///< every step writes it anew, after the sort
};

/// Which plans have a column at all.
enum class ColumnNeed : std::uint8_t {
  kAlways,
  kPairViscosity,  ///< those with PassId::kPairViscosity
  kCorrected,      ///< those whose model corrects_gradients()
  kSolved,         ///< those with PassId::kPressureSolve
  kHeat,           ///< those with PassId::kHeat
};

/// Where the GPU keeps a column: four to sixteen bytes, so that a neighbour is one load in the density pass
/// and two or three in the force pass.
enum class Pack : std::uint8_t {
  kPosition,
  kMotion,
  kId,
  kKind,
  kSolved,
  kHeat,
  kKey,
  kPressed,
  kViscosity,
  kPushA,
  kPushB,
  kDrag,
  kForce,
  kHeating,
  kNone,  ///< it has none
};

// clang-format off
#define SLOSH_FLUID_COLUMNS(ROW)                                                                               \
  /*  name       type           life      saved  hashed  needed by       on the GPU      lane     what it is */ \
  ROW(x,         float,         kCarried, true,  true,   kAlways,        kPosition,      0)    /* m */          \
  ROW(y,         float,         kCarried, true,  true,   kAlways,        kPosition,      1)                     \
  ROW(z,         float,         kCarried, true,  true,   kAlways,        kPosition,      2)                     \
  ROW(vx,        float,         kCarried, true,  true,   kAlways,        kMotion,        0)    /* m/s, half */  \
  ROW(vy,        float,         kCarried, true,  true,   kAlways,        kMotion,        1)    /* a step */     \
  ROW(vz,        float,         kCarried, true,  true,   kAlways,        kMotion,        2)    /* behind x */   \
  ROW(volume,    float,         kCarried, true,  false,  kAlways,        kMotion,        3)    /* m³, from the density pass */ \
  ROW(id,        std::uint32_t, kCarried, true,  true,   kAlways,        kId,            0)    /* fixed for the run */ \
  ROW(kind,      std::uint8_t,  kCarried, false, false,  kAlways,        kKind,          0)    /* RunConstants::kinds; follows from id */ \
  ROW(key,       std::uint32_t, kKey,     true,  false,  kAlways,        kKey,           0)    /* cell, or retired */ \
  ROW(solved,    float,         kCarried, true,  false,  kSolved,        kSolved,        0)    /* Pa, that the last step found */ \
  ROW(temperature, float,       kCarried, true,  true,   kHeat,          kHeat,          0)    /* °C */         \
  ROW(cure,      float,         kCarried, true,  true,   kHeat,          kHeat,          1)    /* 0 to 1: how far it has set */ \
  ROW(from_bodies, float,       kCarried, true,  false,  kHeat,          kHeat,          2)    /* J, since the start */ \
  ROW(thickness, float,         kCarried, true,  false,  kHeat,          kHeat,          3)    /* Pa·s, by the two first */ \
  ROW(heating,   float,         kStep,    false, false,  kHeat,          kHeating,       0)    /* W */          \
  ROW(body_heating, float,      kStep,    false, false,  kHeat,          kHeating,       1)    /* W, of it by bodies */ \
  ROW(pressure,  float,         kStep,    false, false,  kAlways,        kPressed,       3)    /* Pa; kCorrected: V²P, N·m⁴; kIncompressible: wanted ρ⁰/ρ − 1 */ \
  ROW(viscosity, float,         kStep,    false, false,  kPairViscosity, kViscosity,     0)    /* Pa·s */       \
  ROW(pxx,       float,         kStep,    false, false,  kCorrected,     kPushA,         0)    /* N·m⁴, the corrected */ \
  ROW(pxy,       float,         kStep,    false, false,  kCorrected,     kPushA,         1)    /* model's pressure */ \
  ROW(pxz,       float,         kStep,    false, false,  kCorrected,     kPushA,         2)                     \
  ROW(pyy,       float,         kStep,    false, false,  kCorrected,     kPushA,         3)                     \
  ROW(pyz,       float,         kStep,    false, false,  kCorrected,     kPushB,         0)                     \
  ROW(pzz,       float,         kStep,    false, false,  kCorrected,     kPushB,         1)                     \
  ROW(ux,        float,         kStep,    false, false,  kCorrected,     kPushB,         2)    /* Pa·m, what pairs */ \
  ROW(uy,        float,         kStep,    false, false,  kCorrected,     kPushB,         3)    /* viscous */    \
  ROW(uz,        float,         kStep,    false, false,  kCorrected,     kDrag,          0)                     \
  ROW(fx,        float,         kStep,    false, false,  kAlways,        kForce,         0)    /* N, from the force pass */ \
  ROW(fy,        float,         kStep,    false, false,  kAlways,        kForce,         1)                     \
  ROW(fz,        float,         kStep,    false, false,  kAlways,        kForce,         2)
// clang-format on

struct ColumnInfo {
  const char* name;
  std::size_t bytes;  ///< of one entry
  ColumnLife life;
  bool saved;   ///< a saved world holds it (of `key` only whether the particle is retired)
  bool hashed;  ///< World::hash counts it, `id` before the others
  ColumnNeed need;
  Pack pack;
  int lane;  ///< of the pack
};

enum class FluidColumn : std::uint8_t {
#define SLOSH_ROW(name, type, life, saved, hashed, need, pack, lane) name,
  SLOSH_FLUID_COLUMNS(SLOSH_ROW)
#undef SLOSH_ROW
};

inline constexpr std::array kFluidColumns{
#define SLOSH_ROW(name, type, life, saved, hashed, need, pack, lane) \
  ColumnInfo{#name, sizeof(type), ColumnLife::life, saved, hashed, ColumnNeed::need, Pack::pack, lane},
    SLOSH_FLUID_COLUMNS(SLOSH_ROW)
#undef SLOSH_ROW
};

struct Plan;
/// Whether a plan has such columns.
bool needs(const Plan& plan, ColumnNeed need);
/// Bytes that the fluid's columns take for a particle under a plan.
double column_bytes(const Plan& plan);

constexpr const ColumnInfo& info(FluidColumn column) {
  return kFluidColumns[static_cast<std::size_t>(column)];
}

/// One `Store` a column, under the column's name.
template <template <class> class Store>
struct FluidColumns {
#define SLOSH_ROW(name, type, life, saved, hashed, need, pack, lane) Store<type> name;
  SLOSH_FLUID_COLUMNS(SLOSH_ROW)
#undef SLOSH_ROW
};

/// Calls f(column, set.name…) for every row of the table, with one argument a set; info(column) is constant.
template <class F, class... Sets>
void for_each_column(F&& f, Sets&&... sets) {
#define SLOSH_ROW(name, type, life, saved, hashed, need, pack, lane) \
  f(std::integral_constant<FluidColumn, FluidColumn::name>{}, sets.name...);
  SLOSH_FLUID_COLUMNS(SLOSH_ROW)
#undef SLOSH_ROW
}

/// The one column of a set that the constant names.
template <FluidColumn column, class Set>
auto& column_of(Set& set) {
#define SLOSH_ROW(name, type, life, saved, hashed, need, pack, lane) \
  if constexpr (column == FluidColumn::name)                         \
    return set.name;                                                 \
  else
  SLOSH_FLUID_COLUMNS(SLOSH_ROW)
#undef SLOSH_ROW
  static_assert(column == FluidColumn::fz);
}

template <class T>
using PlainColumn = std::vector<T>;

/// Particles by themselves, outside any engine: at the start of a run, and in a saved world.
struct ParticleState : FluidColumns<PlainColumn> {
  /// Makes room in the columns that a saved world holds.
  void resize(std::size_t count) {
    for_each_column(
        [count](auto column, auto& values) {
          if constexpr (info(column).saved) values.resize(count);
        },
        *this);
  }
  std::size_t size() const { return id.size(); }

  std::uint64_t broken = 0;  ///< fluid particles put out of the world so far because they were not finite
};

}  // namespace slosh
