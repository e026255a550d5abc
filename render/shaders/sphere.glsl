// A particle as a sphere splat (paper, section 5.1). GLSL and C++; pure functions.

// Eye depth of the splat's near (side = −1) or far (side = +1) surface, m, at `disc` (−1 to 1 across the splat,
// inside the unit disc). The sphere is seen as if from afar: its outline is a circle in the screen's plane.
SHARED float sphere_depth(float center_depth, float radius, vec2 disc, float side) {
  return center_depth + side * radius * sqrt(max(1.0f - dot(disc, disc), 0.0f));
}

// The same of an ellipsoid (passes/splats.h, SplatShape).
SHARED float ellipsoid_depth(float center_depth, vec2 tilt, float depth_radius, vec2 disc, float side) {
  return center_depth + dot(tilt, disc) + side * depth_radius * sqrt(max(1.0f - dot(disc, disc), 0.0f));
}
