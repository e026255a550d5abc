// One value everywhere.
uniform vec4 fill_with;
bool pixel(ivec2 texel, out vec4 value) {
  value = fill_with;
  return true;
}
#include "pixel_main.glsl"
