// An opaque mesh: scene-linear colour, and the linear eye depth S_d.
#include "surface.glsl"
#include "shadow.glsl"
in vec3 world;
in vec3 world_normal;
in float eye_depth;
uniform vec4 base;       // colour, opacity
uniform vec2 roughness;  // metallic, roughness
layout(location = 0) out vec4 color;  // alpha: share of the light that occlusion may take
layout(location = 1) out float depth;
void main() {
  vec3 n = normalize(world_normal);
  vec3 to_eye = normalize(camera.xyz - world);
  if (dot(n, to_eye) < 0.0 && !gl_FrontFacing) n = -n;  // seen from inside
  Lit lit = light_surface(n, to_eye, base.rgb, roughness.x, roughness.y, light_past_meshes(world, n) * light_past_fluid(world));
  color = vec4(lit.diffuse + lit.specular, lit.ambient);
  depth = eye_depth;
}
