// mixing.vert and mixing.frag by atomics: a row of invocations goes over each particle's texels.
#include "mixing.glsl"
#include "splat_rows.glsl"
#include "sums.glsl"
layout(std430, binding = 2) buffer Sums { uint sums[]; };  // four a texel
uniform ivec2 size;
uniform int count;
void draw_splat(int index) {
  vec4 splat_in = splats[index];
  int channel = int(splat_in.w) - first;
  if (channel < 0 || channel > 3) return;
  SplatPlace place = splat_place(splat_in.xyz);
  float reach = reach_at(place.depth);
  vec2 half_size = 0.5 * vec2(size);
  vec2 middle = (place.center + 1.0) * half_size;
  vec2 texels = reach * place.scale * half_size;
  PixelBox box = pixel_box(middle - texels, middle + texels, size);
  for (ivec2 at = first_place(); at.y < box.size.y; at = next_place(at, box)) {
    if (at.x >= box.size.x) continue;
    ivec2 texel = box.low + at;
    uint steps = uint(share_at(texel, splat_in.xyz, reach) * kShareSteps + 0.5);
    if (steps > 0u) atomicAdd(sums[4 * (texel.y * size.x + texel.x) + channel], steps);
  }
}
void main() {
  for (uint row = first_row(); row < rows_of(count); row += all_rows()) {
    int index = int(splat_of(row, count));
    if (index < count) draw_splat(index);
  }
}
