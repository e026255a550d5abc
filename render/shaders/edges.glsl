// What edges.frag decides by. GLSL and C++; pure functions. Beyond the paper.

const int kLongestEdge = 12;  // pixels to each side in which an edge's end is looked for

// Brightness of a pixel and its neighbours, as shown, 0–1.
struct Cross {
  float middle;
  float above;
  float below;
  float right;
  float left;
};
struct Corners {
  float above_left;
  float above_right;
  float below_left;
  float below_right;
};

SHARED float brightness(vec3 shown) { return dot(shown, vec3(0.299f, 0.587f, 0.114f)); }

SHARED float cross_highest(Cross c) { return max(c.middle, max(max(c.above, c.below), max(c.left, c.right))); }
SHARED float cross_lowest(Cross c) { return min(c.middle, min(min(c.above, c.below), min(c.left, c.right))); }

// Less than an eighth of the brightness, or than four steps in a hundred, is no edge: it is shading.
SHARED bool has_edge(Cross c) {
  float highest = cross_highest(c);
  return highest - cross_lowest(c) > max(0.04f, 0.125f * highest);
}

// The edge runs along a row, not along a column.
SHARED bool edge_is_level(Cross c, Corners k) {
  float level = 2.0f * abs(c.above + c.below - 2.0f * c.middle) + abs(k.above_left + k.below_left - 2.0f * c.left) +
                abs(k.above_right + k.below_right - 2.0f * c.right);
  float upright = 2.0f * abs(c.left + c.right - 2.0f * c.middle) + abs(k.above_left + k.above_right - 2.0f * c.above) +
                  abs(k.below_left + k.below_right - 2.0f * c.below);
  return level >= upright;
}

// Share of the pixel that is the other side's. here: mean brightness over the edge at the pixel. ahead, back: steps to the
// edge's ends, and by how much that mean differs there, 0 where no end was found.
SHARED float other_share(Cross c, Corners k, float here, vec2 ahead, vec2 back) {
  vec2 near = ahead.x <= back.x ? ahead : back;
  // The nearer end says on which side of the pixel's middle the edge runs: where it turns to the pixel's own side, it
  // covers none of this pixel.
  bool crosses = (near.y < 0.0f) != (c.middle < here) && near.y != 0.0f;
  float by_ends = crosses ? 0.5f - near.x / (ahead.x + back.x) : 0.0f;
  // A dot or a thin line has no ends: how far the pixel is off the mean of those around it.
  float mean = (2.0f * (c.above + c.below + c.left + c.right) + k.above_left + k.above_right + k.below_left + k.below_right) / 12.0f;
  float off = clamp(abs(mean - c.middle) / max(cross_highest(c) - cross_lowest(c), 1.0e-4f), 0.0f, 1.0f);
  float soft = off * off * (3.0f - 2.0f * off);
  return max(by_ends, 0.6f * soft * soft);
}
