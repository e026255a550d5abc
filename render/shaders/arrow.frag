// An arrow of the HUD: lit, and seen dimly through what hides it.
#include "surface.glsl"
layout(binding = 0) uniform sampler2D fluid_depth;
layout(binding = 1) uniform sampler2D scene_depth;
in vec3 world_normal;
in vec3 world;
in vec3 arrow_tint;
in float eye_depth;
uniform int has_fluid;
layout(location = 0) out vec4 color;
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float hidden_by = texelFetch(scene_depth, texel, 0).r;
  if (has_fluid != 0) hidden_by = min(hidden_by, texelFetch(fluid_depth, texel, 0).r);
  Lit lit = light_surface(normalize(world_normal), normalize(camera.xyz - world), arrow_tint, 0.0, 0.5, vec3(1.0), 1.0);
  color = vec4(lit.diffuse + lit.specular, eye_depth > hidden_by + 1.0e-3 ? 0.35 : 1.0);
}
