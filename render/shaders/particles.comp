// Particles as they are given, an invocation each: made one vec4, and (CELLS) counted into cells.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) restrict readonly buffer Places { float places[]; };  // m, world; three each
layout(std430, binding = 1) restrict readonly buffer FluidIndices { uint fluid_indices[]; };  // four bytes each
layout(std430, binding = 2) restrict writeonly buffer Particles { vec4 particles[]; };  // world position, fluid index; −1: not drawn
#ifdef CELLS
layout(std430, binding = 3) buffer Counts { uint counts[]; };
layout(std430, binding = 4) restrict writeonly buffer Ranks { uint ranks[]; };  // in the particle's entry
layout(std430, binding = 10) restrict writeonly buffer Owners { uvec2 owners[]; };  // an entry's cell: that of who came first
uniform int entries;
uniform float reach;
#endif
uniform int count;
uniform int fluids;
// What a group reads, side by side: where it comes across a bus, each piece of it comes once.
shared float own[192];
void main() {
  int index = invocation();
  int local = int(gl_LocalInvocationID.x);
  int first = 3 * (index - local);
  for (int k = local; k < 192; k += 64) {
    if (first + k < 3 * count) own[k] = places[first + k];
  }
  barrier();
  if (index >= count) return;
  vec3 at = vec3(own[3 * local], own[3 * local + 1], own[3 * local + 2]);
  uint fluid = fluid_indices[index >> 2] >> (8 * (index & 3)) & 255u;
  bool drawn = fluid < uint(fluids) && !any(isnan(at)) && !any(isinf(at));
  particles[index] = drawn ? vec4(at, float(fluid)) : vec4(0.0, 0.0, 0.0, -1.0);
#ifdef CELLS
  if (!drawn) return;
  ivec3 cell = cell_of(at, reach);
  uint entry = entry_of(cell, entries);
  uint rank = atomicAdd(counts[entry], 1u);
  ranks[index] = rank;
  if (rank == 0u) owners[entry] = packed_cell(cell);
#endif
}
