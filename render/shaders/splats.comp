// Particles as a view sees them: balls in eye axes, and (SHAPED) where their neighbours moved them, as ellipsoids. An invocation each.
#include "frame_block.glsl"
#include "shared.glsl"
#include "smoothing.glsl"
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Splats { vec4 splats[]; };  // eye position, fluid index; −1: not seen
layout(std430, binding = 2) readonly buffer Particles { vec4 particles[]; };
#ifdef SHAPED
struct Shape {
  vec4 outline_depth;  // outline, depth_radius
  vec4 tilt;
};
layout(std430, binding = 1) writeonly buffer Shapes { Shape shapes[]; };
layout(std430, binding = 3) writeonly buffer Balls { vec4 balls[]; };  // where the particles are
layout(std430, binding = 4) readonly buffer Centers { vec4 centers[]; };
struct Ellipsoid {
  vec4 xx_xy_xz_yy;
  vec4 yz_zz;
};
layout(std430, binding = 5) readonly buffer Ellipsoids { Ellipsoid ellipsoids[]; };
#ifdef SEEN
layout(std430, binding = 6) readonly buffer Counts { uint counts[]; };
layout(std430, binding = 8) readonly buffer Seen { uint seen[]; };
uniform int seen_at;  // in Counts: how many are listed there; as many splats there are
#endif
#endif
uniform int count;
uniform float near_plane;
uniform float reach;  // m, from a particle to what may be drawn of it

// Whether a particle at an eye position may be seen.
bool in_view(vec4 particle, vec3 eye) {
  float depth = -eye.z;
  vec2 scale = vec2(1.0) / (abs(unproject.xy) * max(depth, 1.0e-6));
  vec2 off = abs(eye.xy / (unproject.xy * max(depth, 1.0e-6)) - unproject.zw);
  return particle.w >= 0.0 && depth > near_plane && depth < camera.w && all(lessThan(off, 1.0 + reach * scale));
}
vec3 eye_of(vec3 world) { return (eye_from_world * vec4(world, 1.0)).xyz; }

void main() {
  int index = invocation();
  if (index >= count) return;
  vec4 particle = particles[index];
  vec3 eye = eye_of(particle.xyz);
  float fluid = in_view(particle, eye) ? particle.w : -1.0;
#ifdef SHAPED
  balls[index] = vec4(eye, fluid);
#ifdef SEEN
  if (uint(index) >= counts[seen_at]) return;
  particle = particles[seen[index]];
  fluid = in_view(particle, eye_of(particle.xyz)) ? particle.w : -1.0;
#endif
  vec3 center = eye_of(centers[index].xyz);
  if (centers[index].w < 0.0) fluid = -1.0;
  splats[index] = vec4(center, fluid);
  if (fluid < 0.0) return;
  vec4 e = ellipsoids[index].xx_xy_xz_yy;
  vec2 f = ellipsoids[index].yz_zz.xy;
  mat3 turn = mat3(eye_from_world);
  EllipsoidOutline shape = ellipsoid_outline(turn * mat3(e.x, e.y, e.z, e.y, e.w, f.x, e.z, f.x, f.y) * transpose(turn), center);
  shapes[index] = Shape(vec4(shape.outline, shape.depth_radius), vec4(shape.tilt, 0.0, 0.0));
#else
  splats[index] = vec4(eye, fluid);
#endif
}
