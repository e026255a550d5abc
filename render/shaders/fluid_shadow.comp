// fluid_shadow.vert and fluid_shadow.frag by atomics: a row of invocations goes over each point's texels.
#include "fluid_shadow.glsl"
#include "splat_rows.glsl"
#include "sums.glsl"
layout(std430, binding = 0) readonly buffer Particles { vec4 particles[]; };  // world position, fluid index; −1: none
layout(std430, binding = 2) buffer Sums { uint sums[]; };                     // four a texel
uniform int size;  // of the map, texels a side
uniform int count;
uniform int sums_a_texel;  // 3, or 1 where all channels dim alike
uniform int stride;  // particles that one stands for
void draw_splat(int index) {
  vec4 particle = particles[index * stride];
  if (particle.w < 0.0) return;
  vec4 in_clip = clip_from_world * vec4(particle.xyz, 1.0);
  if (any(greaterThan(abs(in_clip.xy), vec2(1.0)))) return;  // as points are clipped
  vec4 optical = dimming_of(in_clip, particle.w);
  vec2 middle = 0.5 * (in_clip.xy + 1.0) * float(size);
  float radius = 0.5 * point_size;
  PixelBox box = pixel_box(middle - radius, middle + radius, ivec2(size));
  for (ivec2 at = first_place(); at.y < box.size.y; at = next_place(at, box)) {
    if (at.x >= box.size.x) continue;
    ivec2 texel = box.low + at;
    vec2 disc = (vec2(texel) + 0.5 - middle) / radius;
    float off = dot(disc, disc);
    if (off >= 1.0) continue;
    vec4 here = dimming_at(optical, off);
    int first = 4 * (texel.y * size + texel.x);
    for (int channel = 0; channel < sums_a_texel; ++channel) {
      uint steps = uint(min(here[channel], kMaxDimming) * kDimmingSteps + 0.5);
      if (steps > 0u) atomicAdd(sums[first + channel], steps);
    }
    atomicMax(sums[first + 3], floatBitsToUint(here.a));
  }
}
void main() {
  for (uint row = first_row(); row < rows_of(count); row += all_rows()) {
    int index = int(splat_of(row, count));
    if (index < count) draw_splat(index);
  }
}
