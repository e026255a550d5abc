// n of Eq 15, as composite.frag takes it.
#include "fluid_data.glsl"
#include "fluid_normal.glsl"
layout(location = 0) out vec4 normal;
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float front = texelFetch(smooth_depth, texel, 0).r;
  if (thickness_at(texel, texelFetch(front_depth, texel, 0).r, front) <= 0.0) discard;
  FluidSurface surface = surface_of_pixel(smooth_depth, eye_position(gl_FragCoord.xy, front), texel);
  normal = vec4(surface.normal, surface.whole);
}
