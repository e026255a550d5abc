// Depth of one sphere, or with SHAPED one ellipsoid. FRONT: blended with MIN, else the far side, blended with MAX.
#include "splat_place.glsl"
in vec2 disc;
flat in float center_depth;
flat in uint fluid;
#ifdef SHAPED
flat in vec3 tilt;
#else
const vec3 tilt = vec3(0.0);
#endif
layout(location = 0) out float depth;
void main() {
  if (dot(disc, disc) > 1.0) discard;
  depth = uintBitsToFloat(splat_depth_bits(center_depth, tilt, disc, fluid));
}
