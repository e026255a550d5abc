// Where each entry of the table begins in the list of particles: a place after those that were given out, whichever they are.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 3) buffer Counts { uint counts[]; };  // an entry each, and what was given out
layout(std430, binding = 5) writeonly buffer Begins { uint begins[]; };
uniform int count;  // entries
shared uint wanted;
shared uint given;
void main() {
  int index = invocation();
  if (gl_LocalInvocationID.x == 0u) wanted = 0u;
  barrier();
  uint before = index < count ? atomicAdd(wanted, counts[index]) : 0u;
  barrier();
  if (gl_LocalInvocationID.x == 0u) given = atomicAdd(counts[count], wanted);
  barrier();
  if (index < count) begins[index] = given + before;
}
