// Where each entry of the table begins in the list of particles: a place after those that were given out, whichever they are. With
// LISTS the entries that have any are listed; else what is to be smoothed: all of them, in batches.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 3) buffer Counts { uint counts[]; };
layout(std430, binding = 5) restrict writeonly buffer Begins { uint begins[]; };
#ifdef LISTS
layout(std430, binding = 9) restrict writeonly buffer Used { uint used[]; };
#else
layout(std430, binding = 11) restrict writeonly buffer Batches { uvec4 batches[]; };
#endif
uniform int count;  // entries
shared uint wanted;
shared uint given;
shared uint listed_here;
shared uint listed_from;
void main() {
  int index = invocation();
  bool leads = gl_LocalInvocationID.x == 0u;
  if (leads) wanted = listed_here = 0u;
  barrier();
  uint own = index < count ? counts[index] : 0u;
#ifdef LISTS
  uint own_listed = own > 0u ? 1u : 0u;
#else
  uint own_listed = batches_of(own);
#endif
  uint before = own > 0u ? atomicAdd(wanted, own) : 0u;
  uint listed_before = own > 0u ? atomicAdd(listed_here, own_listed) : 0u;
  barrier();
  if (leads && wanted > 0u) {
    given = atomicAdd(counts[drawn_at(count)], wanted);
#ifdef LISTS
    listed_from = atomicAdd(counts[used_at(count)], listed_here);
#else
    listed_from = atomicAdd(counts[batches_at(count)], listed_here);
#endif
  }
  barrier();
  if (index < count) begins[index] = own > 0u ? given + before : 0u;
  if (own == 0u) return;
#ifdef LISTS
  used[listed_from + listed_before] = uint(index);
#else
  uint first = given + before;
  for (uint k = 0u; k < own_listed; ++k) {
    uint from = first + k * kBatch;
    batches[listed_from + listed_before + k] = uvec4(uint(index), from, min(from + kBatch, first + own), from);
  }
#endif
}
