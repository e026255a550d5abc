// A triangle of a mesh by compute shaders: what mesh_triangles.comp writes and a pixel reads.
struct Triangle {
  vec4 a;         // eye x, y, depth, m; its item
  vec4 b;
  vec4 c;
  vec4 normal_a;  // world
  vec4 normal_b;
  vec4 normal_c;
};
