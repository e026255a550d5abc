// Where each entry of the table begins in the list of particles: a place after those that were given out, whichever they are; and (LISTS)
// the entries that have any.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 3) buffer Counts { uint counts[]; };
layout(std430, binding = 5) restrict writeonly buffer Begins { uint begins[]; };
#ifdef LISTS
layout(std430, binding = 9) restrict writeonly buffer Used { uint used[]; };
#endif
uniform int count;  // entries
shared uint wanted;
shared uint given;
shared uint used_here;
shared uint used_from;
void main() {
  int index = invocation();
  bool leads = gl_LocalInvocationID.x == 0u;
  if (leads) wanted = used_here = 0u;
  barrier();
  uint own = index < count ? counts[index] : 0u;
  uint before = own > 0u ? atomicAdd(wanted, own) : 0u;
#ifdef LISTS
  uint used_before = own > 0u ? atomicAdd(used_here, 1u) : 0u;
#endif
  barrier();
  if (leads && wanted > 0u) {
    given = atomicAdd(counts[drawn_at(count)], wanted);
#ifdef LISTS
    used_from = atomicAdd(counts[used_at(count)], used_here);
#endif
  }
  barrier();
  if (index < count) begins[index] = own > 0u ? given + before : 0u;
#ifdef LISTS
  if (own > 0u) used[used_from + used_before] = uint(index);
#endif
}
