// A drop of foam: white, lit as a ball that lets light through; under the fluid's surface it fades.
#include "environment.glsl"
#include "shadow.glsl"
layout(binding = 0) uniform sampler2D fluid_depth;
layout(binding = 1) uniform sampler2D scene_depth;
in vec3 world;
in float eye_depth;
in float radius;
in float opacity;
uniform int has_fluid;
layout(location = 0) out vec4 color;  // multiplied by alpha
void main() {
  vec2 across = gl_PointCoord * 2.0 - 1.0;
  float r2 = dot(across, across);
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (r2 > 1.0 || eye_depth > texelFetch(scene_depth, texel, 0).r) discard;
  float below = has_fluid != 0 ? max(eye_depth - texelFetch(fluid_depth, texel, 0).r - 2.0 * radius, 0.0) : 0.0;
  float alpha = opacity * (1.0 - r2 * r2) * exp(-80.0 * below);
  vec3 key = key_light.rgb * 0.31830989 * light_past_meshes(world, vec3(0.0));
  vec3 light = 0.9 * (0.6 * key + ambient_light(vec3(0.0, 1.0, 0.0)));
  color = vec4(light * alpha, alpha);
}
