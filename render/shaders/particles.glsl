// Particles on the GPU: the table of cells that they are counted into. Cells share entries, so whoever looks a cell up asks what lies
// there whether it is of that cell.
#include "shared.glsl"
#include "cell_table.glsl"
const float kFarCell = 1.0e6;  // cells beyond count as this one
ivec3 cell_of(vec3 at, float reach) { return ivec3(clamp(floor(at / reach), vec3(-kFarCell), vec3(kFarCell))); }

// A cell in one value, 21 bits an axis and one that is set.
const uvec2 kNoCell = uvec2(0u);  // of several cells
uvec2 packed_cell(ivec3 cell) {
  uvec3 c = uvec3(cell) & 0x1fffffu;
  return uvec2(c.x | c.y << 21, c.y >> 11 | c.z << 10 | 0x80000000u);
}
ivec3 cell_of_packed(uvec2 p) {
  uvec3 c = uvec3(p.x & 0x1fffffu, p.x >> 21 | (p.y & 0x3ffu) << 11, p.y >> 10 & 0x1fffffu);
  return ivec3(c << 11) >> 11;
}

// Where a particle's neighbours are in the mean, −1 to 1 an axis, to a thousandth.
uint packed_mean(vec3 mean) {
  uvec3 steps = uvec3(clamp(mean * 0.5 + 0.5, vec3(0.0), vec3(1.0)) * 1022.0 + 0.5);
  return steps.x | steps.y << 10 | steps.z << 20;
}
vec3 unpacked_mean(uint steps) { return vec3(uvec3(steps, steps >> 10, steps >> 20) & 1023u) / 511.0 - 1.0; }

// In Counts, after an entry each.
int drawn_at(int entries) { return entries; }         // particles in all entries
int seen_at_end(int entries) { return entries + 1; }  // of those, which are not deep
int used_at(int entries) { return entries + 2; }      // entries with particles

int invocation() { return int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64 + int(gl_LocalInvocationID.x); }
int group_index() { return int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x); }
int all_groups() { return int(gl_NumWorkGroups.x * gl_NumWorkGroups.y); }
