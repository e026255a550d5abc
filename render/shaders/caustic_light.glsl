// What the fluid's surface does to the light on what lies below (caustics.vert); fluid_look.frag has scene_depth, mirrored_bodies.glsl
// scene_tangent.
layout(binding = 6) uniform sampler2D caustic_sums;

// Light there over what a level surface would send there; 1 where much of that comes from parts of the surface that the picture does
// not show. arriving: the light that comes down on what a texel there shows, as caustics.vert reckons it.
float focused(vec2 at, float arriving) {
  vec2 sums = texture(caustic_sums, at).rg;
  float whole = 6.545 * arriving;  // the sum of a point's weights over its texels: π 2.5² / 3
  float known = smoothstep(0.4, 0.8, sums.g / max(whole, 1.0e-6));
  return mix(1.0, min(sums.r / max(sums.g, 1.0e-6), 4.0), known);
}

// Factor on the opaque picture at a pixel (its middle): of its light the light's own part is focused, that from all around not.
vec3 caustic_light(vec2 pixel) {
  float depth = scene_at(pixel);
  if (depth > camera.w) return vec3(1.0);
  vec3 here = eye_position(pixel, depth);
  vec3 n = cross(scene_tangent(here, pixel, vec2(1.0, 0.0)), scene_tangent(here, pixel, vec2(0.0, 1.0)));
  n *= inversesqrt(dot(n, n) + 1.0e-20);
  vec3 world_n = mat3(world_from_eye) * n;
  vec3 world = (world_from_eye * vec4(here, 1.0)).xyz;
  float lit = max(dot(n, to_light_eye.xyz), 0.0);
  vec3 key = key_light.rgb * (0.31830989 * lit * light_past_meshes(world, world_n)) * light_past_fluid(world);
  vec3 around = ambient_light(world_n);
  float arriving = depth * depth * lit / max(dot(n, normalize(-here)), 0.05);
  return (key * focused(pixel * picture.zw, arriving) + around) / (key + around + 1.0e-6);
}
