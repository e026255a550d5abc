#include "fluid_data.glsl"
layout(location = 0) out float thickness;
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  thickness = thickness_at(texel, texelFetch(front_depth, texel, 0).r, texelFetch(smooth_depth, texel, 0).r);
}
