#include "sim/cpu/particles.h"

namespace slosh {

void FluidParticles::resize(std::size_t count) {
  const std::size_t padded = count + kLanes;
  for (Column<float>* column : {&x, &y, &z, &vx, &vy, &vz, &pressure, &volume, &viscosity, &fx, &fy, &fz}) {
    column->assign(padded, 0.0f);
  }
  id.assign(padded, 0);
  kind.assign(padded, 0);
  key.assign(padded, 0);
}

void BoundaryParticles::resize(std::size_t count) {
  const std::size_t padded = count + kLanes;
  for (Column<float>* column : {&x, &y, &z, &vx, &vy, &vz, &pressure, &volume, &viscosity}) {
    column->assign(padded, 0.0f);
  }
  body.assign(padded, 0);
  key.assign(padded, 0);
}

}  // namespace slosh
