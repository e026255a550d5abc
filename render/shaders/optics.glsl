// Optics of the fluid's surface (paper, section 5.2). GLSL and C++; pure functions.

// T(p): how much fluid is seen in front of the scene, m, never negative. Linear eye depths.
SHARED float fluid_thickness(float front_depth, float back_depth, float scene_depth) {
  return max(min(back_depth, scene_depth) - min(front_depth, scene_depth), 0.0f);
}

// The same where front was smoothed and the back was not. The splats as they were drawn say whether a pixel is fluid
// (raw, before the scene), and how thick it is at least, up to a splat's radius: a filter moves the front by less. Never
// 0 where it is fluid: at half size the back misses the outermost pixels.
SHARED float kept_thickness(float smoothed, float raw, float back_depth, float scene_depth, float radius) {
  if (raw >= scene_depth) return 0.0f;
  float own = fluid_thickness(raw, back_depth, scene_depth);
  return max(fluid_thickness(min(smoothed, scene_depth), back_depth, scene_depth), clamp(own, 0.05f * radius, radius));
}

// exp(−T·F_e): the share of the light from behind that comes through, per channel. Extinction in 1/m.
SHARED vec3 transmittance(vec3 extinction, float thickness) { return exp(-thickness * extinction); }

// Eq 15's first term: the fluid's own colour, through which the scene shows.
SHARED vec3 seen_through(vec3 fluid_color, vec3 scene_color, vec3 extinction, float thickness) {
  return mix(fluid_color, scene_color, transmittance(extinction, thickness));
}

// Eq 15's (n·h)^α with Blinn's half vector; all unit vectors away from the surface.
SHARED float blinn(vec3 normal, vec3 to_light, vec3 to_eye, float exponent) {
  vec3 sum = to_light + to_eye;
  float size = length(sum);
  if (size < 1.0e-6f) return 0.0f;  // light straight from behind: no half vector
  return pow(max(dot(normal, sum / size), 0.0f), exponent);
}

// Schlick's Fresnel reflectance. Beyond the paper.
SHARED float schlick(float f0, float cos_angle) {
  float m = clamp(1.0f - cos_angle, 0.0f, 1.0f);
  float m2 = m * m;
  return f0 + (1.0f - f0) * m2 * m2 * m;
}

// GGX distribution times Smith visibility (with its 1/4), as glTF viewers have them: times Fresnel, irradiance's share that
// is mirrored a steradian.
SHARED float ggx(float n_h, float n_l, float n_v, float roughness) {
  float a = roughness * roughness;
  float a2 = a * a;
  float f = n_h * n_h * (a2 - 1.0f) + 1.0f;
  float k = 0.5f * a + 0.0001f;
  float visibility = 0.25f / ((n_l * (1.0f - k) + k) * (n_v * (1.0f - k) + k));
  return a2 / (3.14159265f * f * f + 1.0e-7f) * visibility;
}

// Reflectance of a thin pane: both of its faces mirror, and what goes to and fro between them adds up. `once`: one face.
SHARED float pane_reflectance(float once) { return 2.0f * once / (1.0f + once); }

// Where Eq 15 looks the scene up: the displacement in texture coordinates. refraction (β) is in screen heights
// a metre of thickness; normal.xy in eye axes.
SHARED vec2 refraction_offset(vec3 normal, float refraction, float thickness, float aspect) {
  vec2 heights = vec2(normal.x, normal.y) * (refraction * thickness);
  return vec2(heights.x / aspect, heights.y);
}
