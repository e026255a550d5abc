// A thin pane, for fragments (translucent.frag) and by compute shaders (glass_pixels.comp): it mirrors on both faces and lets the
// rest through, tinted; only a rough one scatters light of its own.
#include "environment.glsl"
#include "shared.glsl"
#include "optics.glsl"

struct Pane {
  vec3 added;    // light, scene-linear
  vec3 through;  // share of what is behind that stays
};

// n: unit, world, either side. paint: colour, opacity.
Pane glass_pane(vec3 world, vec3 n, vec4 paint, float roughness) {
  vec3 to_eye = normalize(camera.xyz - world);
  if (dot(n, to_eye) < 0.0) n = -n;
  float facing = dot(n, to_eye);
  float mirroring = pane_reflectance(schlick(0.04, facing));
  float haze = paint.a * smoothstep(0.1, 0.6, roughness);
  // The way through the pane is longer at a slant.
  vec3 tint = pow(mix(vec3(1.0), paint.rgb, paint.a), vec3(1.0 / max(facing, 0.25)));
  // No shadow and no glint of its own: the mirrored softbox is the glint.
  vec3 mirror = mirrored(reflect(-to_eye, n)) * (1.0 - roughness);
  if (haze == 0.0) return Pane(mirror * mirroring, tint * (1.0 - mirroring));
  vec3 key = key_light.rgb * (0.31830989 * max(dot(n, to_light_world.xyz), 0.0));
  return Pane(paint.rgb * (key + ambient_light(n)) * haze + mirror * mirroring, tint * ((1.0 - haze) * (1.0 - mirroring)));
}
