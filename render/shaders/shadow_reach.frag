// The nearest and the farthest depth of the shadow map about a tile of it. First of its own 8 × 8 texels; then (SPREAD), along one axis and
// along the other, of some tiles to each side, too: so whatever lies within so many tiles of a point is known by one look-up.
layout(location = 0) out vec2 reach;
#ifdef SPREAD
layout(binding = 0) uniform sampler2D tiles;
uniform ivec2 along;
uniform int tiles_beside;
void main() {
  ivec2 last = textureSize(tiles, 0) - 1;
  reach = vec2(1.0, 0.0);
  for (int k = -tiles_beside; k <= tiles_beside; ++k) {
    vec2 there = texelFetch(tiles, clamp(ivec2(gl_FragCoord.xy) + k * along, ivec2(0), last), 0).rg;
    reach = vec2(min(reach.x, there.x), max(reach.y, there.y));
  }
}
#else
layout(binding = 0) uniform sampler2D depths;
void main() {
  vec2 texel = 1.0 / vec2(textureSize(depths, 0));
  vec2 corner = 8.0 * floor(gl_FragCoord.xy) + 1.0;  // between four texels
  reach = vec2(1.0, 0.0);
  for (int k = 0; k < 16; ++k) {
    vec4 four = textureGather(depths, (corner + 2.0 * vec2(k & 3, k >> 2)) * texel);
    vec4 low = min(four, four.wzyx);
    vec4 high = max(four, four.wzyx);
    reach = vec2(min(reach.x, min(low.x, low.y)), max(reach.y, max(high.x, high.y)));
  }
}
#endif
