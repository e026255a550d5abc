// Opaque meshes by compute shaders: mesh.frag and background.frag, a pixel once.
#include "mesh_light.glsl"
#include "mesh_tiles.glsl"
layout(binding = 0) writeonly uniform image2D color_out;  // alpha: share of the light that occlusion may take
layout(binding = 1) writeonly uniform image2D depth_out;
uniform int background;
void main() {
  float nearest[kPixels];
  int triangle[kPixels];
  vec2 ray[kPixels];
  for (int k = 0; k < kPixels; ++k) {
    nearest[k] = 1.0e6;
    triangle[k] = -1;
    ray[k] = ray_of(texel_of(k));
  }
  for (int base = 0; base < count; base += 256) {
    look_for_groups(base);
    for (int from = 0; from < found_groups; from += 4) {
      look_for(from);
      for (int word = 0; word < 8; ++word) {
        for (uint left = at_hand(word); left != 0u; left &= left - 1u) {
          int place = 32 * word + findLSB(left);
          uint blocks = blocks_touched(place);
          int index = triangle_at(from, place);
          Facet t = facets[place];
          for (int k = 0; k < kPixels; ++k) {
            Hit hit;
            if ((blocks >> 2 * k & 1u) == 0u || !meets(t, ray[k], hit)) continue;
            // Where an inside lies on an outside, the outside is seen.
            float compared = hit.outer ? hit.depth : hit.depth * 1.000001;
            if (compared >= nearest[k]) continue;
            nearest[k] = compared;
            triangle[k] = index;
          }
        }
      }
    }
  }
  for (int k = 0; k < kPixels; ++k) {
    ivec2 texel = texel_of(k);
    if (any(greaterThanEqual(texel, ivec2(picture.xy)))) continue;
    if (triangle[k] < 0) {
      vec3 direction = mat3(world_from_eye) * normalize(vec3(ray[k], -1.0));
      imageStore(color_out, texel, vec4(background != 0 ? studio(direction) : vec3(0.0), 0.0));
      imageStore(depth_out, texel, vec4(1.0e6));
      continue;
    }
    Triangle t = triangles[triangle[k]];
    Hit hit;
    meets(facet_of(t), ray[k], hit);
    Item item = items[int(t.a.w)];
    vec3 world = world_of(ray[k], hit.depth);
    vec3 to_eye = normalize(camera.xyz - world);
    vec3 n = normal_of(t, hit.weights);
    if (dot(n, to_eye) < 0.0 && !hit.outer) n = -n;
    vec4 color = mesh_light(world, n, to_eye, item.base.rgb, item.surface.xy, 1.0);
    imageStore(color_out, texel, with_own_light(color, item.emissive.rgb));
    imageStore(depth_out, texel, vec4(hit.depth));
  }
}
