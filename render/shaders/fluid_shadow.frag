// Sums how much each channel is dimmed on the light's way through the fluid; alpha keeps the particle nearest the light.
#include "fluid_shadow.glsl"
in vec4 optical;
layout(location = 0) out vec4 depth_of_fluid;
void main() {
  vec2 disc = gl_PointCoord * 2.0 - 1.0;
  float off = dot(disc, disc);
  if (off >= 1.0) discard;  // the corners of the point's square are no fluid: they must not raise its top
  depth_of_fluid = dimming_at(optical, off);
}
