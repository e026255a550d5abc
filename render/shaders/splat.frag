// Depth of one sphere. FRONT: blended with MIN, the fluid's index in the lowest four bits of the depth, so that the
// nearest particle brings its own look. Else the far side, blended with MAX.
#include "frame_block.glsl"
#include "shared.glsl"
#include "sphere.glsl"
in vec2 disc;
flat in float center_depth;
flat in uint fluid;
layout(location = 0) out float depth;
void main() {
  if (dot(disc, disc) > 1.0) discard;
#ifdef FRONT
  float d = max(sphere_depth(center_depth, splat.x, disc, -1.0), 1.0e-4);
  depth = uintBitsToFloat((floatBitsToUint(d) & ~15u) | fluid);
#else
  depth = sphere_depth(center_depth, splat.x, disc, 1.0);
#endif
}
