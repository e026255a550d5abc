// What mixing.comp summed.
#include "sums.glsl"
layout(std430, binding = 2) readonly buffer Sums { uint sums[]; };
uniform ivec2 size;
bool pixel(ivec2 texel, out vec4 value) {
  int first = 4 * (texel.y * size.x + texel.x);
  value = vec4(sums[first], sums[first + 1], sums[first + 2], sums[first + 3]) / kShareSteps;
  return true;
}
#include "pixel_main.glsl"
