// splat.vert and splat.frag by atomics: a row of invocations goes over each splat's pixels.
#include "splat_place.glsl"
#include "splat_rows.glsl"
layout(binding = 0, r32ui) uniform uimage2D depths;
uniform int count;
void main() {
  int index = int(splat_row(count));
  if (index >= count) return;
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
  for (int i = int(gl_LocalInvocationID.x); i < box.size.x * box.size.y; i += LANES) {
    ivec2 texel = box.low + ivec2(i % box.size.x, i / box.size.x);
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
