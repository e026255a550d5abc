// Depth of one sphere, or with SHAPED one ellipsoid. FRONT: blended with MIN, the fluid's index in the lowest four bits of
// the depth, so that the nearest particle brings its own look. Else the far side, blended with MAX.
#include "frame_block.glsl"
#include "shared.glsl"
#include "sphere.glsl"
in vec2 disc;
flat in float center_depth;
flat in uint fluid;
#ifdef SHAPED
flat in vec3 tilt;
#endif
layout(location = 0) out float depth;
float surface_depth(float side) {
#ifdef SHAPED
  return ellipsoid_depth(center_depth, tilt.xy, tilt.z, disc, side);
#else
  return sphere_depth(center_depth, splat.x, disc, side);
#endif
}
void main() {
  if (dot(disc, disc) > 1.0) discard;
#ifdef FRONT
  float d = max(surface_depth(-1.0), 1.0e-4);
  depth = uintBitsToFloat((floatBitsToUint(d) & ~15u) | fluid);
#else
  depth = surface_depth(1.0);
#endif
}
