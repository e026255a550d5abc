// A triangle of a mesh by compute shaders: what mesh_triangles.comp writes and a pixel reads.
struct Triangle {
  vec4 a;         // eye x, y, depth, m; its item
  vec4 b;         // with c and normal_a, in w: the plane it lies in, over its distance from the eye; 0: none, it is seen edge on
  vec4 c;
  vec4 normal_a;  // world
  vec4 normal_b;
  vec4 normal_c;
};
