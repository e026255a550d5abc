// Which cells lie deep in the fluid: their 26 neighbours are all well filled, so that nobody sees a particle of theirs as the first
// or the last of the fluid. Eight invocations an entry share the 27; of cells that share an entry, the first particle's.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 3) restrict readonly buffer Counts { uint counts[]; };
layout(std430, binding = 5) restrict readonly buffer Begins { uint begins[]; };
layout(std430, binding = 7) restrict readonly buffer Sorted { vec4 sorted[]; };
layout(std430, binding = 8) restrict writeonly buffer Deep { uint deep[]; };  // an entry each: 1 or 0
uniform int count;  // entries
uniform float reach;

const int kShare = 8;  // invocations an entry
shared uint open_cells[64 / kShare];

// The cell's particles are half as many as there are inside a fluid. Where the first and the last of its entry are the cell's, all are
// taken to be.
bool filled(ivec3 cell) {
  uint entry = entry_of(cell, count);
  uint all_of_entry = counts[entry];
  if (all_of_entry < 8u) return false;
  uint first = begins[entry];
  uint end = first + all_of_entry;
  if (cell_of(sorted[first].xyz, reach) == cell && cell_of(sorted[end - 1u].xyz, reach) == cell) return true;
  uint own = 0u;
  for (uint k = first; k < end && own < 8u; ++k) own += cell_of(sorted[k].xyz, reach) == cell ? 1u : 0u;
  return own >= 8u;
}

void main() {
  int local = int(gl_LocalInvocationID.x);
  int index = invocation() / kShare;
  int own = local / kShare;
  bool any = index < count && counts[index] > 0u;
  if (local % kShare == 0) open_cells[own] = 0u;
  barrier();
  if (any) {
    ivec3 middle = cell_of(sorted[begins[index]].xyz, reach);
    bool all_round = true;
    for (int c = local % kShare; c < 27 && all_round; c += kShare) all_round = filled(middle + ivec3(c % 3, c / 3 % 3, c / 9) - 1);
    if (!all_round) atomicOr(open_cells[own], 1u);
  }
  barrier();
  if (index < count && local % kShare == 0) deep[index] = any && open_cells[own] == 0u ? 1u : 0u;
}
