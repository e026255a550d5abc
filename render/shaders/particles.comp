// Particles as they are given, an invocation each: made one vec4, and (CELLS) counted into cells.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Places { float places[]; };       // m, world
layout(std430, binding = 1) readonly buffer FluidIndices { uint fluid_indices[]; };  // four bytes each
layout(std430, binding = 2) writeonly buffer Particles { vec4 particles[]; };  // world position, fluid index; −1: not drawn
#ifdef CELLS
layout(std430, binding = 3) buffer Counts { uint counts[]; };
layout(std430, binding = 4) writeonly buffer Ranks { uint ranks[]; };  // in the particle's entry
uniform int entries;
uniform float reach;
#endif
uniform int count;
uniform int fluids;
uniform int floats;  // from one place to the next
void main() {
  int index = invocation();
  if (index >= count) return;
  vec3 at = vec3(places[floats * index], places[floats * index + 1], places[floats * index + 2]);
  uint fluid = fluid_indices[index >> 2] >> (8 * (index & 3)) & 255u;
  bool drawn = fluid < uint(fluids) && !any(isnan(at)) && !any(isinf(at));
  particles[index] = drawn ? vec4(at, float(fluid)) : vec4(0.0, 0.0, 0.0, -1.0);
#ifdef CELLS
  if (drawn) ranks[index] = atomicAdd(counts[entry_of(cell_of(at, reach), entries)], 1u);
#endif
}
