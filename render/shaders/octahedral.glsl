// Directions on a square (Cigolle et al. 2014). GLSL and C++; pure functions. The square's middle is straight up, its corners
// straight down.

// direction: any length. Both coordinates −1 to 1.
SHARED vec2 octahedral(vec3 direction) {
  vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  vec2 folded = vec2((1.0f - abs(d.z)) * (d.x >= 0.0f ? 1.0f : -1.0f), (1.0f - abs(d.x)) * (d.z >= 0.0f ? 1.0f : -1.0f));
  return d.y >= 0.0f ? vec2(d.x, d.z) : folded;
}

// The inverse, unit.
SHARED vec3 from_octahedral(vec2 at) {
  float up = 1.0f - abs(at.x) - abs(at.y);
  vec2 folded = vec2((1.0f - abs(at.y)) * (at.x >= 0.0f ? 1.0f : -1.0f), (1.0f - abs(at.x)) * (at.y >= 0.0f ? 1.0f : -1.0f));
  return up >= 0.0f ? normalize(vec3(at.x, up, at.y)) : normalize(vec3(folded.x, up, folded.y));
}

// Texture coordinate of a square of `size` texels a side whose outermost texels' middles lie on its edge: texels that meet
// over the edge are alike, so that a sampler needs no more than to clamp.
SHARED vec2 octahedral_texture(vec3 direction, float size) {
  return (octahedral(direction) * 0.5f + 0.5f) * ((size - 1.0f) / size) + 0.5f / size;
}
