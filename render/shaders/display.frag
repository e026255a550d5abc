// Scene-linear light to the screen, through the table that OpenColorIO filled.
#include "shared.glsl"
#include "display_shaper.glsl"
layout(binding = 0) uniform sampler2D linear_color;
layout(binding = 1) uniform sampler3D display_table;
uniform float exposure;
uniform vec2 table_scale;  // (size − 1)/size, 0.5/size
layout(location = 0) out vec4 color;
void main() {
  vec3 lit = texelFetch(linear_color, ivec2(gl_FragCoord.xy), 0).rgb * exposure;
  vec3 shown = texture(display_table, display_shape(lit) * table_scale.x + table_scale.y).rgb;
  color = vec4(shown, 1.0);
}
