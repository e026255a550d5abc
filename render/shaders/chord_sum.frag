// What chord.comp summed, in metres; the sums are zero again after.
#include "sums.glsl"
layout(std430, binding = 2) buffer Sums { uint sums[]; };
uniform ivec2 size;
bool pixel(ivec2 texel, out vec4 value) {
  value = vec4(float(sums[texel.y * size.x + texel.x]) / kChordSteps);
  sums[texel.y * size.x + texel.x] = 0u;
  return true;
}
#include "pixel_main.glsl"
