// splat.vert and splat.frag by atomics: a row of invocations goes over each splat's pixels.
#include "splat_place.glsl"
#include "splat_rows.glsl"
layout(binding = 0, r32ui) uniform uimage2D depths;
uniform int count;
uniform int seen_at;  // in Counts: how many there are, where nobody knows before; −1: `count`
layout(std430, binding = 6) readonly buffer Counts { uint counts[]; };
void draw_splat(int index) {
  vec4 splat_in = splats[index];
  if (splat_in.w < 0.0) return;
  SplatPlace place = splat_place(splat_in.xyz);
#ifdef SHAPED
  Shape shape = shapes[index];
  vec3 outline = shape.outline_depth.xyz;
  vec3 tilt = vec3(shape.tilt.xy, shape.outline_depth.w);
#else
  vec3 outline = vec3(splat.x, 0.0, splat.x);
  vec3 tilt = vec3(0.0);
#endif
  vec2 half_size = 0.5 * vec2(imageSize(depths));
  vec2 middle = (place.center + 1.0) * half_size;  // in pixels
  vec2 reach = reach_of_outline(outline) * place.scale * half_size;
  PixelBox box = pixel_box(middle - reach, middle + reach, imageSize(depths));
  vec2 metres = 1.0 / (place.scale * half_size);  // a pixel
  for (ivec2 at = first_place(); at.y < box.size.y; at = next_place(at, box)) {
    if (at.x >= box.size.x) continue;
    ivec2 texel = box.low + at;
    vec2 disc = disc_of_off(outline, (vec2(texel) + 0.5 - middle) * metres);
    if (dot(disc, disc) > 1.0) continue;
    uint bits = splat_depth_bits(place.depth, tilt, disc, uint(splat_in.w));
    // A look before spares most atomics: what is read may be old, but never nearer (farther) than what is there.
    uint there = imageLoad(depths, texel).x;
#ifdef FRONT
    if (bits < there) imageAtomicMin(depths, texel, bits);
#else
    if (bits > there) imageAtomicMax(depths, texel, bits);
#endif
  }
}
void main() {
  int drawn = seen_at < 0 ? count : int(counts[seen_at]);
  for (uint row = first_row(); row < rows_of(drawn); row += all_rows()) {
    int index = int(splat_of(row, drawn));
    if (index < drawn) draw_splat(index);
  }
}
