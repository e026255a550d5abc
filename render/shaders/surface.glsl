// Light off a solid surface: Lambert and GGX under the key light, the studio's reflection (metallic-roughness).
#include "environment.glsl"
#include "shared.glsl"
#include "optics.glsl"

struct Lit {
  vec3 diffuse;   // key light and sky, scattered by the body
  vec3 specular;  // mirrored off the surface
  float ambient;  // share of the whole that occlusion may take away, 0–1
};

// normal and to_eye: unit, world. light: share of the key light that arrives, per channel; open: share of the light from all
// around that does.
Lit light_surface(vec3 normal, vec3 to_eye, vec3 base_color, float metallic, float roughness, vec3 light, float open) {
  vec3 to_light = to_light_world.xyz;
  float n_l = max(dot(normal, to_light), 0.0);
  float n_v = max(dot(normal, to_eye), 1.0e-3);
  vec3 half_way = normalize(to_light + to_eye);
  vec3 f0 = mix(vec3(0.04), base_color, metallic);
  vec3 albedo = base_color * (1.0 - metallic);
  float rough = max(roughness, 0.05);

  vec3 key = key_light.rgb * light * n_l;
  vec3 around = ambient_light(normal) * open;
  vec3 rest = f0 + (max(vec3(1.0 - rough), f0) - f0) * schlick(0.0, n_v);
  vec3 mirror = rough_mirrored(reflect(-to_eye, normal), rough) * open;

  Lit lit;
  lit.diffuse = albedo * (key * 0.31830989 + around);
  vec3 fresnel = f0 + (1.0 - f0) * schlick(0.0, dot(half_way, to_eye));
  vec3 glint = key * fresnel * ggx(max(dot(normal, half_way), 0.0), n_l, n_v, rough);
  lit.specular = glint + rest * mirror;
  float whole = dot(lit.diffuse + lit.specular, vec3(1.0));
  lit.ambient = dot(albedo * around + rest * mirror, vec3(1.0)) / max(whole, 1.0e-5);
  return lit;
}
