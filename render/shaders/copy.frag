// A texture as it is.
layout(binding = 0) uniform sampler2D source;
bool pixel(ivec2 texel, out vec4 value) {
  value = texelFetch(source, texel, 0);
  return true;
}
#include "pixel_main.glsl"
