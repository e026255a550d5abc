// What maps do to a surface (glTF 2.0, 3.9). GLSL and C++; pure functions.

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
