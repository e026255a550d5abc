// Particles as a view sees them: balls in eye axes, and (SHAPED) where their neighbours moved them, as ellipsoids. An invocation each; SEEN:
// of those alone that cells_deep.comp listed.
#include "in_view.glsl"
#include "shared.glsl"
#include "smoothing.glsl"
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) restrict writeonly buffer Splats { vec4 splats[]; };  // eye position, fluid index; −1: not seen
layout(std430, binding = 2) restrict readonly buffer Particles { vec4 particles[]; };
#ifdef SHAPED
struct Shape {
  vec4 outline_depth;  // outline, depth_radius
  vec4 tilt;
};
layout(std430, binding = 1) restrict writeonly buffer Shapes { Shape shapes[]; };
layout(std430, binding = 4) restrict readonly buffer Centers { vec4 centers[]; };
struct Ellipsoid {
  vec4 xx_xy_xz_yy;
  vec2 yz_zz;
  uint mean;
  float weights;
};
layout(std430, binding = 5) restrict readonly buffer Ellipsoids { Ellipsoid ellipsoids[]; };
#ifdef SEEN
layout(std430, binding = 6) restrict readonly buffer Counts { uint counts[]; };
layout(std430, binding = 8) restrict readonly buffer Seen { uint seen[]; };
uniform int seen_at;  // in Counts: how many are listed there; as many splats there are
#endif
#endif
uniform int count;

#ifdef SHAPED
#include "depth_normal.glsl"
layout(binding = 0) uniform sampler2D scene_depth;
uniform vec2 lying;  // reach and particle radius, m; 0: nothing lies on walls

// What few others surround lies on the wall that is behind it in the picture, where that is near (passes/smooth_centers).
void lie_down(vec3 eye, float weights, uint mean_steps, inout vec3 center, inout mat3 matrix) {
  if (lying.y <= 0.0 || weights >= kLyingMany) return;
  vec2 at = ((center.xy / (unproject.xy * -center.z) - unproject.zw) * 0.5 + 0.5) * picture.xy;
  if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, picture.xy))) return;
  float scene = texelFetch(scene_depth, ivec2(at), 0).r;
  if (scene > camera.w) return;
  vec3 wall = eye_position(floor(at) + 0.5, scene);
  vec3 normal = depth_normal(scene_depth, wall, ivec2(at), camera.w);
  float away = dot(eye - wall, normal);
  if (away < 0.0) return;
  vec3 mean = mat3(eye_from_world) * unpacked_mean(mean_steps) * lying.x;
  float share = lying_share(weights, mean, normal, away, lying.y);
  center -= share * dot(center - wall, normal) * normal;
  matrix += share * (lying_ellipsoid(weights, normal, lying.y) - matrix);
}
#endif

void main() {
  int index = invocation();
#ifdef SEEN
  if (index >= count || uint(index) >= counts[seen_at]) return;
  vec4 particle = particles[seen[index]];
#else
  if (index >= count) return;
  vec4 particle = particles[index];
#endif
  vec3 eye = eye_of(particle.xyz);
  float fluid = in_view(particle, eye) ? particle.w : -1.0;
#ifdef SHAPED
  if (fluid < 0.0) {
    splats[index] = vec4(eye, fluid);
    return;
  }
  vec3 center = eye_of(centers[index].xyz);
  Ellipsoid own = ellipsoids[index];
  vec4 e = own.xx_xy_xz_yy;
  vec2 f = own.yz_zz;
  mat3 turn = mat3(eye_from_world);
  mat3 matrix = turn * mat3(e.x, e.y, e.z, e.y, e.w, f.x, e.z, f.x, f.y) * transpose(turn);
  lie_down(eye, own.weights, own.mean, center, matrix);
  splats[index] = vec4(center, fluid);
  EllipsoidOutline shape = ellipsoid_outline(matrix, center);
  shapes[index] = Shape(vec4(shape.outline, shape.depth_radius), vec4(shape.tilt, 0.0, 0.0));
#else
  splats[index] = vec4(eye, fluid);
#endif
}
