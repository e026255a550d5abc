// Particles into their cells' lists, in whatever order they were counted; then (SORT) in the order in which they were given, so that
// sums over neighbours come out the same each time.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 2) restrict readonly buffer Particles { vec4 particles[]; };
layout(std430, binding = 3) restrict readonly buffer Counts { uint counts[]; };
layout(std430, binding = 4) readonly buffer Ranks { uint ranks[]; };
layout(std430, binding = 5) restrict readonly buffer Begins { uint begins[]; };
layout(std430, binding = 6) buffer Listed { uint listed[]; };
#ifdef SORT
layout(std430, binding = 7) writeonly buffer Sorted { vec4 sorted[]; };
#endif
uniform int count;
uniform int entries;
uniform float reach;
void main() {
  int index = invocation();
  if (index >= count) return;
#ifdef SORT
  if (uint(index) >= counts[entries]) sorted[index] = vec4(0.0, 0.0, 0.0, -1.0);  // fewer are drawn than given
#endif
  if (particles[index].w < 0.0) return;
  uint entry = entry_of(cell_of(particles[index].xyz, reach), entries);
#ifdef SORT
  uint before = 0u;
  uint first = begins[entry];
  uint end = first + counts[entry];
  for (uint k = first; k < end; ++k) before += listed[k] < uint(index) ? 1u : 0u;
  sorted[first + before] = particles[index];
#else
  listed[begins[entry] + ranks[index]] = uint(index);
#endif
}
