// chord.vert and chord.frag by atomics: a row of invocations goes over each point's texels.
#include "chord_point.glsl"
#include "splat_place.glsl"
#include "splat_rows.glsl"
#include "sums.glsl"
layout(std430, binding = 2) buffer Sums { uint sums[]; };  // a texel each
uniform ivec2 size;
uniform int count;
void main() {
  int index = int(splat_row(count));
  if (index >= count) return;
  if (splats[index].w < 0.0) return;
  SplatPlace place = splat_place(splats[index].xyz);
  if (any(greaterThan(abs(place.center), vec2(1.0)))) return;  // as points are clipped
  ChordPoint point = chord_point(place.depth);
  vec2 middle = 0.5 * (place.center + 1.0) * vec2(size);
  float radius = 0.5 * point.size;
  PixelBox box = pixel_box(middle - radius, middle + radius, size);
  for (int i = int(gl_LocalInvocationID.x); i < box.size.x * box.size.y; i += LANES) {
    ivec2 texel = box.low + ivec2(i % box.size.x, i / box.size.x);
    vec2 disc = (vec2(texel) + 0.5 - middle) / radius;
    uint steps = uint(chord_at(texel, disc, place.depth, point.weight) * kChordSteps + 0.5);
    if (steps > 0u) atomicAdd(sums[texel.y * size.x + texel.x], steps);
  }
}
