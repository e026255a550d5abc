// Ends a pass over pixels, `bool pixel(ivec2 texel, out vec4 value)` (false: nothing is written there): a fragment each, or with
// COMPUTE an invocation each. The one place where the two ways differ (gl/pixel_program.h).
#ifdef COMPUTE
#ifndef EACH
#define EACH 1  // pixels of an invocation: where little is done for one, it takes as long to start the groups
#endif
layout(local_size_x = 16, local_size_y = 8) in;
layout(binding = 0) writeonly uniform image2D pixels_out;
void main() {
  ivec2 first = ivec2(gl_WorkGroupID.xy) * ivec2(16, 8 * EACH) + ivec2(gl_LocalInvocationID.xy);
  for (int k = 0; k < EACH; ++k) {
    ivec2 texel = first + ivec2(0, 8 * k);
    if (any(greaterThanEqual(texel, imageSize(pixels_out)))) return;
    vec4 value = vec4(0.0);
    if (pixel(texel, value)) imageStore(pixels_out, texel, value);
  }
}
#else
layout(location = 0) out vec4 pixel_out;
void main() {
  vec4 value = vec4(0.0);
  if (!pixel(ivec2(gl_FragCoord.xy), value)) discard;
  pixel_out = value;
}
#endif
