// The room that the frame stands in: our studio's formula, or (FAR_LIGHT) a picture of a room made ready by render/environment.
#include "frame_block.glsl"
#include "shared.glsl"
#include "room.glsl"
#ifdef FAR_LIGHT
#include "octahedral.glsl"
layout(binding = 10) uniform sampler2D far_light;              // FAR_LIGHT texels a side, octahedral
layout(binding = 11) uniform sampler2DArray blurred_far_light;  // BLURRED_FAR_LIGHT a side; roughness 0.2, 0.4, … 1
layout(std140, binding = 2) uniform DiffuseLight { vec4 diffuse_light[9]; };  // spherical harmonics of irradiance / π

vec3 studio(vec3 direction) { return textureLod(far_light, octahedral_texture(direction, float(FAR_LIGHT)), 0.0).rgb; }
vec3 mirrored(vec3 direction) { return studio(direction); }

vec3 ambient_light(vec3 d) {
  vec3 sum = diffuse_light[0].rgb * 0.282095 + 0.488603 * (diffuse_light[1].rgb * d.y + diffuse_light[2].rgb * d.z + diffuse_light[3].rgb * d.x) +
             1.092548 * (diffuse_light[4].rgb * (d.x * d.y) + diffuse_light[5].rgb * (d.y * d.z) + diffuse_light[7].rgb * (d.x * d.z)) +
             diffuse_light[6].rgb * (0.315392 * (3.0 * d.z * d.z - 1.0)) + diffuse_light[8].rgb * (0.546274 * (d.x * d.x - d.y * d.y));
  return max(sum, vec3(0.0));
}

// What a rough surface mirrors. The light itself is no part of it.
vec3 rough_studio(vec3 direction, float roughness) {
  float layer = clamp(5.0 * roughness, 0.0, 5.0) - 1.0;  // −1: as sharp as it is
  float low = floor(layer);
  vec2 at = octahedral_texture(direction, float(BLURRED_FAR_LIGHT));
  vec3 blurred = textureLod(blurred_far_light, vec3(at, min(low + 1.0, 4.0)), 0.0).rgb;
  vec3 sharper = low < 0.0 ? studio(direction) : textureLod(blurred_far_light, vec3(at, max(low, 0.0)), 0.0).rgb;
  return mix(sharper, blurred, layer - low);
}
vec3 rough_mirrored(vec3 direction, float roughness) { return rough_studio(direction, roughness); }
#else
Room room() { return Room(sky.rgb, horizon.rgb, ground.rgb, softbox.rgb, to_light_world.xyz); }
vec3 studio(vec3 direction) { return room_radiance(room(), direction); }
vec3 mirrored(vec3 direction) { return room_mirrored(room(), direction); }
vec3 ambient_light(vec3 normal) { return room_ambient(room(), normal); }

// What a rough surface mirrors, without and with the light.
vec3 rough_studio(vec3 direction, float roughness) {
  return mix(studio(direction), ambient_light(direction), min(1.4 * roughness, 1.0));
}
vec3 rough_mirrored(vec3 direction, float roughness) {
  return mix(mirrored(direction), ambient_light(direction), min(1.4 * roughness, 1.0));
}
#endif
