// Where a splat lies in the picture, and the depths it leaves there; for splats drawn as triangles (splat.vert) and by
// atomics (splat.comp).
#include "frame_block.glsl"
#include "shared.glsl"
#include "sphere.glsl"

struct SplatPlace {
  vec2 center;  // clip space
  vec2 scale;   // clip space a metre, at the splat's depth
  float depth;  // m
};
SplatPlace splat_place(vec3 eye) {
  float depth = -eye.z;
  vec2 scale = vec2(1.0) / (unproject.xy * depth);
  return SplatPlace(eye.xy * scale - unproject.zw, scale, depth);
}

// The outline of passes/splats.h, SplatShape; a sphere's is (radius, 0, radius). From a place on the disc to metres off the
// centre, back again, and how far it reaches.
vec2 off_of_disc(vec3 outline, vec2 disc) { return vec2(outline.x * disc.x, outline.y * disc.x + outline.z * disc.y); }
vec2 disc_of_off(vec3 outline, vec2 off) {
  float x = off.x / outline.x;
  return vec2(x, (off.y - outline.y * x) / outline.z);
}
vec2 reach_of_outline(vec3 outline) { return vec2(outline.x, length(outline.yz)); }

// tilt: and the depth radius.
float splat_depth(float center_depth, vec3 tilt, vec2 disc, float side) {
#ifdef SHAPED
  return ellipsoid_depth(center_depth, tilt.xy, tilt.z, disc, side);
#else
  return sphere_depth(center_depth, splat.x, disc, side);
#endif
}

// FRONT: the near side with the fluid's index in the lowest four bits, so that the nearest particle brings its own look. Else the
// far side. Bits of a positive float: as whole numbers they are in the same order.
uint splat_depth_bits(float center_depth, vec3 tilt, vec2 disc, uint fluid) {
#ifdef FRONT
  float d = max(splat_depth(center_depth, tilt, disc, -1.0), 1.0e-4);
  return (floatBitsToUint(d) & ~15u) | fluid;
#else
  return floatBitsToUint(splat_depth(center_depth, tilt, disc, 1.0));
#endif
}

layout(std430, binding = 0) readonly buffer Splats { vec4 splats[]; };  // eye position, fluid index
#ifdef SHAPED
struct Shape {
  vec4 outline_depth;  // outline, depth_radius
  vec4 tilt;
};
layout(std430, binding = 1) readonly buffer Shapes { Shape shapes[]; };
#endif
