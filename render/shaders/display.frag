// Scene-linear light to the screen: by OpenColorIO's own text, which stands before this (BY_TEXT), or through the table that it filled.
#include "shared.glsl"
#include "display_shaper.glsl"
layout(binding = 0) uniform sampler2D linear_color;
#ifndef BY_TEXT
layout(binding = 1) uniform sampler3D display_table;
#endif
uniform float exposure;
uniform float dither;      // of a step of eight bits
uniform vec2 table_scale;  // (size − 1)/size, 0.5/size
bool pixel(ivec2 texel, out vec4 value) {
  vec3 lit = texelFetch(linear_color, texel, 0).rgb * exposure;
#ifdef BY_TEXT
  vec3 shown = clamp(display_color(vec4(clamp(lit, 0.0, 65504.0), 1.0)).rgb, 0.0, 1.0);
#else
  vec3 shown = texture(display_table, display_shape(lit) * table_scale.x + table_scale.y).rgb;
#endif
  // Interleaved gradient noise (Jimenez 2014): even over any few pixels, and the same in every picture, so that nothing flickers.
  float noise = fract(52.9829189 * fract(dot(vec2(texel) + 0.5, vec2(0.06711056, 0.00583715)))) - 0.5;
  // Rounded here: a chip that stores eight bits does not always take the nearest (an H200 was off by 0.56 of a step).
  value = vec4(floor(clamp(shown + noise * dither, 0.0, 1.0) * 255.0 + 0.5) / 255.0, 1.0);
  return true;
}
#include "pixel_main.glsl"
