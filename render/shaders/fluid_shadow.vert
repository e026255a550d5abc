// A particle as a point in the light's view.
#include "fluid_shadow.glsl"
layout(location = 0) in vec4 particle;  // world position; the fluid's index
out vec4 optical;
void main() {
  gl_Position = clip_from_world * vec4(particle.xyz, 1.0);
  gl_PointSize = point_size;
  optical = dimming_of(gl_Position, particle.w);
}
