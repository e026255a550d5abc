// Light off an opaque mesh, for fragments (mesh.frag) and by compute shaders (mesh_pixels.comp).
#include "surface.glsl"
#include "shadow.glsl"

// Scene-linear colour; alpha: share of the light that occlusion may take. n and to_eye: unit, world. metal_rough: metallic,
// roughness; open: share of the light from all around that arrives.
vec4 mesh_light(vec3 world, vec3 n, vec3 to_eye, vec3 painted, vec2 metal_rough, float open) {
  Lit lit = light_surface(n, to_eye, painted, metal_rough.x, metal_rough.y, light_past_meshes(world, n) * light_past_fluid(world), open);
  return vec4(lit.diffuse + lit.specular, lit.ambient);
}

// With light that the surface gives off itself: occlusion takes none of it.
vec4 with_own_light(vec4 color, vec3 own) {
  float before = dot(color.rgb, vec3(1.0));
  return vec4(color.rgb + own, color.a * before / max(before + dot(own, vec3(1.0)), 1.0e-5));
}
