// Which entries have a cell that is half as full as one inside a fluid: eight invocations an entry look at its particles. Of cells that share
// an entry it is that of the particle given first; the others count as not filled.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 2) restrict readonly buffer Particles { vec4 particles[]; };
layout(std430, binding = 3) restrict readonly buffer Counts { uint counts[]; };
layout(std430, binding = 5) restrict readonly buffer Begins { uint begins[]; };
layout(std430, binding = 6) restrict readonly buffer Listed { uint listed[]; };
layout(std430, binding = 9) restrict writeonly buffer Filled { uvec2 filled[]; };  // packed_cell() or kNotFilled
uniform int count;  // entries
uniform float reach;

const int kShare = 8;  // invocations an entry
const uint kFew = 8u;
shared uint earliest[64 / kShare];
shared uint of_cell[64 / kShare];

void main() {
  int index = invocation() / kShare;
  int own = int(gl_LocalInvocationID.x) / kShare;
  uint part = uint(gl_LocalInvocationID.x) % uint(kShare);
  uint many = index < count ? counts[index] : 0u;
  bool enough = many >= kFew;
  uint first = enough ? begins[index] : 0u;
  if (part == 0u) {
    earliest[own] = 0xffffffffu;
    of_cell[own] = 0u;
  }
  barrier();
  if (enough) {
    uint least = 0xffffffffu;
    for (uint k = part; k < many; k += uint(kShare)) least = min(least, listed[first + k]);
    atomicMin(earliest[own], least);
  }
  barrier();
  ivec3 cell = ivec3(0);
  if (enough) {
    cell = cell_of(particles[earliest[own]].xyz, reach);
    uint same = 0u;
    for (uint k = part; k < many; k += uint(kShare)) same += cell_of(particles[listed[first + k]].xyz, reach) == cell ? 1u : 0u;
    atomicAdd(of_cell[own], same);
  }
  barrier();
  if (part == 0u && index < count) filled[index] = of_cell[own] >= kFew ? packed_cell(cell) : kNotFilled;
}
