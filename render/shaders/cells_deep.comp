// Which particles are not deep in the fluid, listed: of cells whose 26 neighbours and themselves are all well filled (cells_filled.comp)
// nobody sees one as the first or the last of the fluid. Eight invocations an entry share the 27. In which order they are listed differs from
// picture to picture; nothing is summed in it.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 3) buffer Counts { uint counts[]; };  // an entry each; of all; of those listed here
layout(std430, binding = 5) restrict readonly buffer Begins { uint begins[]; };
layout(std430, binding = 7) restrict readonly buffer Sorted { vec4 sorted[]; };
layout(std430, binding = 8) restrict writeonly buffer Seen { uint seen[]; };
layout(std430, binding = 9) restrict readonly buffer Filled { uvec2 filled[]; };
uniform int count;  // entries
uniform float reach;

const int kShare = 8;  // invocations an entry
shared uint open_cells[64 / kShare];
shared uint listed_here;
shared uint listed_from;

void main() {
  int local = int(gl_LocalInvocationID.x);
  int index = invocation() / kShare;
  int own = local / kShare;
  uint part = uint(local % kShare);
  uint many = index < count ? counts[index] : 0u;
  uvec2 key = many > 0u ? filled[index] : kNotFilled;
  ivec3 middle = cell_of_packed(key);
  if (part == 0u) open_cells[own] = key == kNotFilled ? 1u : 0u;
  if (local == 0) listed_here = 0u;
  barrier();
  if (key != kNotFilled) {
    bool all_round = true;
    for (int c = int(part); c < 27; c += kShare) {
      ivec3 cell = middle + ivec3(c % 3, c / 3 % 3, c / 9) - 1;
      all_round = all_round && filled[entry_of(cell, count)] == packed_cell(cell);
    }
    if (!all_round) atomicOr(open_cells[own], 1u);
  }
  barrier();
  bool deep = open_cells[own] == 0u;
  uint first = many > 0u ? begins[index] : 0u;
  uint own_listed = 0u;
  for (uint k = part; k < many; k += uint(kShare)) own_listed += !deep || cell_of(sorted[first + k].xyz, reach) != middle ? 1u : 0u;
  uint before = own_listed > 0u ? atomicAdd(listed_here, own_listed) : 0u;
  barrier();
  if (local == 0) listed_from = listed_here > 0u ? atomicAdd(counts[count + 1], listed_here) : 0u;
  barrier();
  before += listed_from;
  for (uint k = part; k < many; k += uint(kShare)) {
    if (!deep || cell_of(sorted[first + k].xyz, reach) != middle) seen[before++] = first + k;
  }
}
