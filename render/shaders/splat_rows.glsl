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

// Which splat an invocation's row takes, of `count`; none if it is not below. Rows that run at the same time take splats from 64 parts of
// all: those that follow each other lie side by side, where atomics would wait for each other. Groups on two axes are more than are
// needed: rows beyond the last take none.
uint splat_row(int count) {
  uint row = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.y + gl_LocalInvocationID.y;
  uint part = uint(count + 63) >> 6;
  return row < 64u * part ? (row & 63u) * part + (row >> 6) : uint(count);
}
