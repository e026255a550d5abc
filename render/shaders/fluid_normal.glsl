// The fluid's surface from its smoothed depths: normal, and whether the surface goes on all round. Who includes it has `scene_depth`.
#include "frame_block.glsl"
#include "shared.glsl"
#include "bilateral.glsl"
#include "depth_normal.glsl"

const float kBodyGap = 3.0;  // splat radii

struct FluidSurface {
  vec3 normal;  // unit, eye axes, towards the eye
  float whole;  // 1 well inside the surface, 0 where it ends within half a splat: its normals there are a sphere's rim
};

// The surface's depth `step_to` texels on, or 0 where it does not go on: no fluid, the picture's edge, another surface.
float depth_beside(sampler2D depths, float here, ivec2 texel, ivec2 step_to) {
  ivec2 at = texel + step_to;
  bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(picture.xy)));
  float d = inside ? texelFetch(depths, at, 0).r : 1.0e6;
  return d < kFluidDepthLimit && abs(d - here) * splat.z < 1.0 ? d : 0.0;
}
// The same, or 0 for what a body hides, which is not smoothed.
float seen_beside(sampler2D depths, float here, ivec2 texel, ivec2 step_to) {
  float d = depth_beside(depths, here, texel, step_to);
  ivec2 at = clamp(texel + step_to, ivec2(0), ivec2(picture.xy) - 1);
  return d > texelFetch(scene_depth, at, 0).r + splat.x ? 0.0 : d;
}

// Along one axis of the picture: two-sided where both neighbours are there, else to the one that is.
vec3 surface_tangent(sampler2D depths, vec3 here, ivec2 texel, ivec2 axis) {
  float ahead = seen_beside(depths, -here.z, texel, axis);
  float behind = seen_beside(depths, -here.z, texel, -axis);
  vec2 middle = vec2(texel) + 0.5;
  vec3 from = behind > 0.0 ? eye_position(middle - vec2(axis), behind) : here;
  vec3 to = ahead > 0.0 ? eye_position(middle + vec2(axis), ahead) : here;
  // A lone pixel faces the eye.
  return ahead > 0.0 || behind > 0.0 ? to - from : eye_position(middle + vec2(axis), -here.z) - here;
}

// The surface goes up to a body that stands in it: it ends here before other fluid, and in the gap is the body, not air. Its
// normals go on as they do beside the body (narrow_range.glsl). Taken for a rim, water at a ball's foot mirrored nothing: a flat patch
// of the water's own colour.
bool body_beside(sampler2D depths, float here, ivec2 texel, ivec2 step_to) {
  ivec2 at = clamp(texel + step_to, ivec2(0), ivec2(picture.xy) - 1);
  float hidden = texelFetch(depths, at, 0).r;
  float body = texelFetch(scene_depth, at, 0).r;
  return hidden < kFluidDepthLimit && body < hidden && abs(body - here) < kBodyGap * splat.x;
}

FluidSurface fluid_surface(sampler2D depths, vec3 here, ivec2 texel) {
  FluidSurface surface;
  surface.normal = normalize(cross(surface_tangent(depths, here, texel, ivec2(1, 0)),
                                   surface_tangent(depths, here, texel, ivec2(0, 1))));
  int reach = int(clamp(0.5 * splat.x * splat.y / -here.z, 2.0, 8.0));
  float found = 0.0;
  for (int k = 0; k < 4; ++k) {
    ivec2 way = k < 2 ? ivec2(k == 0 ? reach : -reach, 0) : ivec2(0, k == 2 ? reach : -reach);
    bool goes_on = depth_beside(depths, -here.z, texel, way) > 0.0 || body_beside(depths, -here.z, texel, way);
    found += goes_on ? 1.0 : 0.0;
  }
  surface.whole = max(found - 3.0, 0.0);
  return surface;
}

// The same, or section 5.2's where that is asked for as it stands.
FluidSurface surface_of_pixel(sampler2D depths, vec3 here, ivec2 texel) {
  if (switches.w <= 0.5) return fluid_surface(depths, here, texel);
  return FluidSurface(depth_normal(depths, here, texel, kFluidDepthLimit), 1.0);
}
