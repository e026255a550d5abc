// A glass: what lies behind (BEHIND) or in front of the fluid's surface, blended (premultiplied alpha).
#include "surface.glsl"
#include "shadow.glsl"
#include "bilateral.glsl"
layout(binding = 0) uniform sampler2D fluid_depth;
in vec3 world;
in vec3 world_normal;
in float eye_depth;
uniform vec4 base;
uniform vec2 roughness;
uniform int has_fluid;
layout(location = 0) out vec4 color;
void main() {
  float surface = has_fluid != 0 ? texelFetch(fluid_depth, ivec2(gl_FragCoord.xy), 0).r : 1.0e6;
#ifdef BEHIND
  if (eye_depth <= surface) discard;
#else
  if (eye_depth > surface) discard;
#endif
  vec3 to_eye = normalize(camera.xyz - world);
  vec3 n = normalize(world_normal);
  if (dot(n, to_eye) < 0.0) n = -n;
  Lit lit = light_surface(n, to_eye, base.rgb, roughness.x, roughness.y, vec3(light_reaching(world, n)));
  float opacity = base.a + (1.0 - base.a) * schlick(0.0, dot(n, to_eye));
  color = vec4(lit.diffuse * base.a + lit.specular, opacity);
}
