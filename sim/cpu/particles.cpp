#include "sim/cpu/particles.h"

namespace slosh {

namespace {

template <class C>
void make(C& column, std::size_t count) {
  if (column.empty()) column.assign(count + kLanes, {});
}

}  // namespace

void FluidParticles::provide(const Plan& plan, std::size_t count) {
  for_each_column(
      [&](auto column, auto& values) {
        if (needs(plan, info(column).need)) make(values, count);
      },
      *this);
  near_wall.resize(count);
}

void GatheredColumns::provide(const Plan& plan, std::size_t count) {
  for_each_column(
      [&](auto column, auto& values) {
        if (info(column).life == ColumnLife::kCarried && needs(plan, info(column).need)) make(values, count);
      },
      *this);
}

void MirrorColumns::resize(std::size_t count) {
  for (Column<float>* column : {&nx, &ny, &nz, &xx, &xy, &xz, &yy, &yz, &zz})
    column->assign(count + kLanes, 0.0f);
}

void MirrorColumns::set(std::size_t i, const MirrorPlane& plane) {
  nx[i] = plane.normal.x;
  ny[i] = plane.normal.y;
  nz[i] = plane.normal.z;
  xx[i] = plane.bend.xx;
  xy[i] = plane.bend.xy;
  xz[i] = plane.bend.xz;
  yy[i] = plane.bend.yy;
  yz[i] = plane.bend.yz;
  zz[i] = plane.bend.zz;
}

void BoundaryParticles::resize(std::size_t count) {
  const std::size_t padded = count + kLanes;
  for (Column<float>* column : {&x, &y, &z, &vx, &vy, &vz, &pressure, &volume, &viscosity, &reach}) {
    column->assign(padded, 0.0f);
  }
  body.assign(padded, 0);
}

}  // namespace slosh
