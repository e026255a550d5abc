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
  vec4 yz_zz;
};
layout(std430, binding = 5) restrict readonly buffer Ellipsoids { Ellipsoid ellipsoids[]; };
#ifdef SEEN
layout(std430, binding = 6) restrict readonly buffer Counts { uint counts[]; };
layout(std430, binding = 8) restrict readonly buffer Seen { uint seen[]; };
uniform int seen_at;  // in Counts: how many are listed there; as many splats there are
#endif
#endif
uniform int count;

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
  splats[index] = vec4(center, fluid);
  vec4 e = ellipsoids[index].xx_xy_xz_yy;
  vec2 f = ellipsoids[index].yz_zz.xy;
  mat3 turn = mat3(eye_from_world);
  EllipsoidOutline shape = ellipsoid_outline(turn * mat3(e.x, e.y, e.z, e.y, e.w, f.x, e.z, f.x, f.y) * transpose(turn), center);
  shapes[index] = Shape(vec4(shape.outline, shape.depth_radius), vec4(shape.tilt, 0.0, 0.0));
#else
  splats[index] = vec4(eye, fluid);
#endif
}
