// chord.vert and chord.frag by atomics: a row of invocations goes over each point's texels, of particles where they are in the world, which
// nobody asked yet whether they are seen.
#include "chord_point.glsl"
#include "splat_place.glsl"
#include "splat_rows.glsl"
#include "sums.glsl"
#include "in_view.glsl"
layout(std430, binding = 2) buffer Sums { uint sums[]; };  // a texel each
uniform ivec2 size;
uniform int count;
void draw_splat(int index) {
  vec4 ball = splats[index];
  if (ball.w < 0.0) return;
  ball.xyz = eye_of(ball.xyz);
  if (!in_view(ball, ball.xyz)) return;
  SplatPlace place = splat_place(ball.xyz);
  if (any(greaterThan(abs(place.center), vec2(1.0)))) return;  // as points are clipped
  ChordPoint point = chord_point(place.depth);
  vec2 middle = 0.5 * (place.center + 1.0) * vec2(size);
  float radius = 0.5 * point.size;
  PixelBox box = pixel_box(middle - radius, middle + radius, size);
  for (ivec2 at = first_place(); at.y < box.size.y; at = next_place(at, box)) {
    if (at.x >= box.size.x) continue;
    ivec2 texel = box.low + at;
    vec2 disc = (vec2(texel) + 0.5 - middle) / radius;
    uint steps = uint(chord_at(texel, disc, place.depth, point.weight) * kChordSteps + 0.5);
    if (steps > 0u) atomicAdd(sums[texel.y * size.x + texel.x], steps);
  }
}
void main() {
  for (uint row = first_row(); row < rows_of(count); row += all_rows()) {
    int index = int(splat_of(row, count));
    if (index < count) draw_splat(index);
  }
}
