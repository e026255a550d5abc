// A photographer's studio: soft sky, bright horizon, darker floor, one large light.
#include "frame_block.glsl"

// Radiance from a world direction (unit), without the light.
vec3 studio(vec3 direction) {
  float up = direction.y;
  vec3 above = mix(horizon.rgb, sky.rgb, sqrt(clamp(up, 0.0, 1.0)));
  return up >= 0.0 ? above : mix(horizon.rgb, ground.rgb, smoothstep(0.0, 0.55, -up));
}

// What a smooth surface mirrors: the studio with the light's softbox.
vec3 mirrored(vec3 direction) {
  float to_box = dot(direction, to_light_world.xyz);
  return studio(direction) + softbox.rgb * smoothstep(0.90, 0.97, to_box);
}

// Irradiance / π on a surface of this normal, from all but the light.
vec3 ambient_light(vec3 normal) {
  vec3 middle = mix(horizon.rgb, 0.5 * (sky.rgb + ground.rgb), 0.5);
  vec3 pole = normal.y >= 0.0 ? sky.rgb : ground.rgb;
  return mix(middle, pole, 0.75 * abs(normal.y));
}
