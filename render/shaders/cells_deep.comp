// Which particles are not deep in the fluid, listed: of cells whose 26 neighbours and themselves are all well filled (half as full as one
// inside a fluid) nobody sees one as the first or the last of the fluid. Entries that cells share count as not filled. Eight invocations
// share the 27. In which order they are listed differs from picture to picture; nothing is summed in it.
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 3) buffer Counts { uint counts[]; };
layout(std430, binding = 5) restrict readonly buffer Begins { uint begins[]; };
layout(std430, binding = 8) restrict writeonly buffer Seen { uint seen[]; };  // sorted particles
layout(std430, binding = 9) restrict readonly buffer Used { uint used[]; };
layout(std430, binding = 10) restrict readonly buffer Owners { uvec2 owners[]; };
uniform int entries;

const uint kFew = 8u;
const int kShare = 8;  // invocations an entry
const int kOwn = 64 / kShare;
shared uint open_cells[kOwn];
shared uint sizes[kOwn];  // particles
shared uint places[kOwn];  // of an entry's first in what is listed

bool filled(ivec3 cell) {
  uint entry = entry_of(cell, entries);
  return counts[entry] >= kFew && owners[entry] == packed_cell(cell);
}

void main() {
  int own = int(gl_LocalInvocationID.x) / kShare;
  int part = int(gl_LocalInvocationID.x) % kShare;
  int all_used = int(counts[used_at(entries)]);
  for (int turn = group_index() * kOwn; turn < all_used; turn += all_groups() * kOwn) {
    bool has_one = turn + own < all_used;
    uint entry = has_one ? used[turn + own] : 0u;
    uint many = has_one ? counts[entry] : 0u;
    uvec2 owner = has_one ? owners[entry] : kNoCell;
    bool may_be_deep = many >= kFew && owner != kNoCell;
    if (part == 0) {
      open_cells[own] = may_be_deep ? 0u : 1u;
      sizes[own] = many;
    }
    barrier();
    if (may_be_deep) {
      ivec3 middle = cell_of_packed(owner);
      bool all_round = true;
      for (int c = part; c < 27; c += kShare) all_round = all_round && filled(middle + ivec3(c % 3, c / 3 % 3, c / 9) - 1);
      if (!all_round) open_cells[own] = 1u;
    }
    barrier();
    if (gl_LocalInvocationID.x == 0u) {
      uint particles = 0u;
      for (int i = 0; i < kOwn; ++i) {
        places[i] = particles;
        uint here = open_cells[i] != 0u ? sizes[i] : 0u;
        particles += here;
      }
      uint from = particles > 0u ? atomicAdd(counts[seen_at_end(entries)], particles) : 0u;
      for (int i = 0; i < kOwn; ++i) places[i] += from;
    }
    barrier();
    if (has_one && open_cells[own] != 0u) {
      uint first = begins[entry];
      for (uint k = uint(part); k < many; k += uint(kShare)) seen[places[own] + k] = first + k;
    }
    barrier();
  }
}
