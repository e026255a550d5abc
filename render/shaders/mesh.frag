// An opaque mesh: scene-linear colour, and the linear eye depth S_d. What a look has is compiled in (textures.h): BASE_MAP,
// METAL_ROUGH_MAP, NORMAL_MAP, OCCLUSION_MAP, EMISSIVE_MAP, each with TEXTURED; EMITS; HOLES; WET (wet_maps.h).
#include "mesh_light.glsl"
#include "material.glsl"
in vec3 world;
in vec3 world_normal;
in float eye_depth;
uniform vec4 base;       // colour, opacity
uniform vec2 roughness;  // metallic, roughness
#ifdef TEXTURED
in vec2 texcoord;
#endif
#ifdef BASE_MAP
layout(binding = 16) uniform sampler2D base_map;
#endif
#ifdef METAL_ROUGH_MAP
layout(binding = 17) uniform sampler2D metal_rough_map;
#endif
#ifdef NORMAL_MAP
layout(binding = 18) uniform sampler2D normal_map;
uniform float normal_scale;
#endif
#ifdef OCCLUSION_MAP
layout(binding = 19) uniform sampler2D occlusion_map;
uniform float occlusion_strength;
#endif
#ifdef EMITS
uniform vec3 emissive;
#ifdef EMISSIVE_MAP
layout(binding = 20) uniform sampler2D emissive_map;
#endif
#endif
#ifdef HOLES
uniform float alpha_cutoff;
#endif
#ifdef WET
layout(binding = 21) uniform sampler3D wet_map;
uniform mat4 wet_from_world;  // to texture coordinates
uniform vec3 wet_low;         // between these lies all that is wet
uniform vec3 wet_high;
uniform float wet_off;        // m before a face
#endif
layout(location = 0) out vec4 color;  // alpha: share of the light that occlusion may take
layout(location = 1) out float depth;
void main() {
  vec3 n = normalize(world_normal);
  vec3 to_eye = normalize(camera.xyz - world);
  vec3 painted = base.rgb;
  vec2 metal_rough = roughness;
  float open = 1.0;
#ifdef BASE_MAP
  vec4 base_texel = texture(base_map, texcoord);
  painted *= base_texel.rgb;
#endif
#ifdef METAL_ROUGH_MAP
  metal_rough *= texture(metal_rough_map, texcoord).bg;
#endif
#ifdef NORMAL_MAP
  vec3 face = n;
  n = mapped_normal(n, dFdx(world), dFdy(world), dFdx(texcoord), dFdy(texcoord), texture(normal_map, texcoord).xyz, normal_scale);
  if (dot(face, to_eye) < 0.0 && !gl_FrontFacing) n = -n;  // seen from inside
#else
  if (dot(n, to_eye) < 0.0 && !gl_FrontFacing) n = -n;
#endif
#ifdef OCCLUSION_MAP
  open = mapped_occlusion(texture(occlusion_map, texcoord).r, occlusion_strength);
#endif
#ifdef HOLES
  if (base_texel.a < alpha_cutoff) discard;
#endif
#ifdef WET
  vec3 at = (wet_from_world * vec4(world + wet_off * n, 1.0)).xyz;
  if (all(greaterThan(at, wet_low)) && all(lessThan(at, wet_high))) {
    float wet = smoothstep(0.25, 0.75, textureLod(wet_map, at, 0.0).r);
    painted = wetted(painted, metal_rough, wet);
    metal_rough.y = mix(metal_rough.y, min(metal_rough.y, kWetRoughness), wet);
  }
#endif
  color = mesh_light(world, n, to_eye, painted, metal_rough, open);
#ifdef EMITS
  vec3 own = emissive;
#ifdef EMISSIVE_MAP
  own *= texture(emissive_map, texcoord).rgb;
#endif
  color = with_own_light(color, own);
#endif
  depth = eye_depth;
}
