// A particle's share in the fluid's surface round it, where several fluids meet; for splats drawn as triangles (mixing.vert) and by
// atomics (mixing.comp). Beyond the paper, whose front-most particle brings its look.
#include "splat_place.glsl"
layout(binding = 0) uniform sampler2D smooth_depth;
uniform int pixels;    // of the picture along one of a texel here
uniform float radius;  // m, to which a particle counts
uniform int first;     // fluids before those of this target's four channels

// Never so small that a surface far away falls between the texels.
float reach_at(float depth) { return max(radius, 1.5 * float(pixels) * depth / splat.y); }

// The pixel that stands for a texel.
ivec2 pixel_of(ivec2 texel) { return min(texel * pixels + pixels / 2, ivec2(picture.xy) - 1); }

// Of a particle at `center` (eye axes) in the surface's point at a texel: as SPH interpolates what particles carry, by their
// distance in space. So what is behind another surface has no share in it.
float share_at(ivec2 texel, vec3 center, float reach) {
  ivec2 at = pixel_of(texel);
  vec3 off = eye_position(vec2(at) + 0.5, texelFetch(smooth_depth, at, 0).r) - center;
  float near = max(1.0 - dot(off, off) / (reach * reach), 0.0);
  return near * near;
}
