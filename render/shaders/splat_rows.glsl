// Splats by compute shaders: a row of LANES invocations each (gl/pixel_program.h, RowProgram), 128 in a group, groups on two axes as one
// is too short for a million.
layout(local_size_x = LANES, local_size_y = 128 / LANES) in;

struct PixelBox {
  ivec2 low;
  ivec2 size;  // none if the box is off the picture
};

// The pixels whose middles lie between two places, within a picture.
PixelBox pixel_box(vec2 low, vec2 high, ivec2 picture_size) {
  ivec2 first = max(ivec2(ceil(low - 0.5)), ivec2(0));
  ivec2 last = min(ivec2(floor(high - 0.5)), picture_size - 1);
  return PixelBox(first, max(last - first + 1, ivec2(0)));
}

// Where an invocation's row stands in a box, by turns, from its low corner: in blocks of 8 × 4 (of short rows 4 × 2) pixels, an invocation
// each, so that nothing is divided and neighbours add to neighbours. Beyond the box on the right there is nothing to do.
const ivec2 kBlock = LANES == 32 ? ivec2(8, 4) : ivec2(4, LANES / 4);
ivec2 first_place() { return ivec2(int(gl_LocalInvocationID.x) % kBlock.x, int(gl_LocalInvocationID.x) / kBlock.x); }
ivec2 next_place(ivec2 at, PixelBox box) {
  int own = int(gl_LocalInvocationID.x) % kBlock.x;
  at.x += kBlock.x;
  return at.x - own < box.size.x ? at : ivec2(own, at.y + kBlock.y);
}

// Which splat a row takes, of `count`; none if it is not below. Rows that run at the same time take splats from 64 parts of all: those that
// follow each other lie side by side, where atomics would wait for each other. There may be fewer rows than splats: each goes on by as many
// as there are.
uint first_row() { return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.y + gl_LocalInvocationID.y; }
uint all_rows() { return gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.y; }
uint rows_of(int count) { return uint(count + 63) & ~63u; }
uint splat_of(uint row, int count) { return (row & 63u) * (uint(count + 63) >> 6) + (row >> 6); }
