// Particles into their cells' lists, in whatever order they were counted; then (SORT) in the order in which they were given, so that
// sums over neighbours come out the same each time.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 2) restrict readonly buffer Particles { vec4 particles[]; };
layout(std430, binding = 3) restrict readonly buffer Counts { uint counts[]; };
layout(std430, binding = 4) restrict readonly buffer Ranks { uint ranks[]; };
layout(std430, binding = 5) restrict readonly buffer Begins { uint begins[]; };
layout(std430, binding = 6) buffer Listed { uint listed[]; };
#ifdef SORT
layout(std430, binding = 7) restrict writeonly buffer Sorted { vec4 sorted[]; };
#else
layout(std430, binding = 10) buffer Owners { uvec2 owners[]; };
#endif
uniform int count;
uniform int entries;
uniform float reach;
void main() {
  int index = invocation();
  if (index >= count) return;
#ifdef SORT
  if (uint(index) >= counts[drawn_at(entries)]) sorted[index] = vec4(0.0, 0.0, 0.0, -1.0);  // fewer are drawn than given
#endif
  vec4 particle = particles[index];
  if (particle.w < 0.0) return;
  ivec3 cell = cell_of(particle.xyz, reach);
  uint entry = entry_of(cell, entries);
  uint first = begins[entry];
#ifdef SORT
  uint before = 0u;
  uint end = first + counts[entry];
  for (uint k = first; k < end; ++k) before += listed[k] < uint(index) ? 1u : 0u;
  sorted[first + before] = particle;
#else
  listed[first + ranks[index]] = uint(index);
  // An entry that cells share has no owner. What another one wrote meanwhile says no more than that.
  if (owners[entry] != packed_cell(cell)) owners[entry] = kNoCell;
#endif
}
