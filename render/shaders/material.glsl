// What maps do to a surface (glTF 2.0, 3.9), and water. GLSL and C++; pure functions.

// A normal map's normal. n: unit. p1, p2 and t1, t2: how position and texture coordinate change along two ways over the
// surface (edges of its triangle, steps of a pixel). texel: 0–1 a channel, y towards smaller v. Where the coordinates stand
// still it is n.
SHARED vec3 mapped_normal(vec3 n, vec3 p1, vec3 p2, vec2 t1, vec2 t2, vec3 texel, float scale) {
  float turn = t1.x * t2.y - t2.x * t1.y;
  float side = turn < 0.0f ? -1.0f : 1.0f;
  vec3 along_u = (p1 * t2.y - p2 * t1.y) * side;
  vec3 along_v = (p2 * t1.x - p1 * t2.x) * side;
  vec3 tangent = along_u - n * dot(n, along_u);
  float size = length(tangent);
  if (!(size > 1.0e-20f)) return n;
  tangent = tangent / size;
  vec3 up = cross(n, tangent);  // glTF's: against v
  if (dot(up, along_v) > 0.0f) up = -up;
  vec3 local = texel * 2.0f - 1.0f;
  return normalize(tangent * (local.x * scale) + up * (local.y * scale) + n * max(local.z, 1.0e-3f));
}

// Share of the light from all around that arrives.
SHARED float mapped_occlusion(float texel, float strength) { return 1.0f + strength * (texel - 1.0f); }

// What of a matt surface's light comes out of the fluid that wets it (Lekner & Dorf 1988, "Why some things are darker when wet"): of what
// it scatters the share `kept` is mirrored back onto it by the fluid's surface, 1 − (1 − 0.06) / n² at n = 1.33. painted: its albedo.
SHARED vec3 wet_share(vec3 painted) {
  const float kept = 0.46f;
  return vec3(1.0f - kept) / (vec3(1.0f) - kept * painted);
}

// The colour of a surface that is wet in a share. Metal is no darker, nor is what has a skin that lets no fluid in, as its gloss shows.
const float kWetRoughness = 0.12f;
SHARED vec3 wetted(vec3 painted, vec2 metal_rough, float wet) {
  float open = wet * (1.0f - metal_rough.x) * smoothstep(0.2f, 0.5f, metal_rough.y);
  return painted * mix(vec3(1.0f), wet_share(clamp(painted, 0.0f, 0.95f)), open);
}
