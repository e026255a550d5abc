// Whether a particle may be seen by a view, for splats.comp and chord.comp.
#include "frame_block.glsl"
uniform float near_plane;
uniform float reach;  // m, from a particle to what may be drawn of it

vec3 eye_of(vec3 world) { return (eye_from_world * vec4(world, 1.0)).xyz; }

// eye: its position there; w: the fluid's index, −1: not drawn.
bool in_view(vec4 particle, vec3 eye) {
  float depth = -eye.z;
  vec2 scale = vec2(1.0) / (abs(unproject.xy) * max(depth, 1.0e-6));
  vec2 off = abs(eye.xy / (unproject.xy * max(depth, 1.0e-6)) - unproject.zw);
  return particle.w >= 0.0 && depth > near_plane && depth < camera.w && all(lessThan(off, 1.0 + reach * scale));
}
