#include "scenes/mesh/tree.h"

#include <algorithm>
#include <cmath>

namespace slosh::mesh {
namespace {

constexpr std::int32_t kLeafSize = 4;

float squared_distance_to_box(const glm::vec3& p, const glm::vec3& low, const glm::vec3& high) {
  const glm::vec3 way = p - glm::clamp(p, low, high);
  return glm::dot(way, way);
}

bool ray_meets_box(const glm::vec3& origin, const glm::vec3& inverse, const glm::vec3& low,
                   const glm::vec3& high) {
  const glm::vec3 t0 = (low - origin) * inverse;
  const glm::vec3 t1 = (high - origin) * inverse;
  const glm::vec3 near = glm::min(t0, t1);
  const glm::vec3 far = glm::max(t0, t1);
  const float enter = std::max({near.x, near.y, near.z, 0.0f});
  // A hair of slack: a ray in the plane of a flat box must still meet its triangles.
  return enter <= std::min({far.x, far.y, far.z}) * (1.0f + 1e-5f) + 1e-9f;
}

}  // namespace

glm::vec3 nearest_on_triangle(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                              const glm::vec3& c) {
  const glm::vec3 ab = b - a;
  const glm::vec3 ac = c - a;
  const glm::vec3 ap = p - a;
  const float d1 = glm::dot(ab, ap);
  const float d2 = glm::dot(ac, ap);
  if (d1 <= 0.0f && d2 <= 0.0f) return a;
  const glm::vec3 bp = p - b;
  const float d3 = glm::dot(ab, bp);
  const float d4 = glm::dot(ac, bp);
  if (d3 >= 0.0f && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) return a + ab * (d1 / (d1 - d3));
  const glm::vec3 cp = p - c;
  const float d5 = glm::dot(ab, cp);
  const float d6 = glm::dot(ac, cp);
  if (d6 >= 0.0f && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) return a + ac * (d2 / (d2 - d6));
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0f && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const float sum = va + vb + vc;
  if (!(sum > 0.0f))
    return a;  // a sliver without area: one of the edges above already served in all but name
  return a + ab * (vb / sum) + ac * (vc / sum);
}

MeshTree::MeshTree(const TriangleMesh& mesh) {
  corners_.reserve(mesh.triangles.size());
  std::vector<glm::vec3> centers;
  centers.reserve(mesh.triangles.size());
  for (const glm::uvec3& t : mesh.triangles) {
    corners_.push_back({mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
    centers.push_back((corners_.back().a + corners_.back().b + corners_.back().c) / 3.0f);
  }
  order_.resize(corners_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::int32_t>(i);
  nodes_.reserve(corners_.size());
  if (!corners_.empty()) build(0, static_cast<std::int32_t>(order_.size()), centers);
}

void MeshTree::build(std::int32_t begin, std::int32_t end, const std::vector<glm::vec3>& centers) {
  Node node{glm::vec3(INFINITY), glm::vec3(-INFINITY), begin, end - begin};
  glm::vec3 center_low(INFINITY);
  glm::vec3 center_high(-INFINITY);
  for (std::int32_t i = begin; i < end; ++i) {
    const Corners& t = corners_[order_[i]];
    node.low = glm::min(node.low, glm::min(t.a, glm::min(t.b, t.c)));
    node.high = glm::max(node.high, glm::max(t.a, glm::max(t.b, t.c)));
    center_low = glm::min(center_low, centers[order_[i]]);
    center_high = glm::max(center_high, centers[order_[i]]);
  }
  const std::size_t self = nodes_.size();
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) return;
  const glm::vec3 extent = center_high - center_low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::int32_t a, std::int32_t b) {
                     const float ca = centers[a][axis];
                     const float cb = centers[b][axis];
                     return ca != cb ? ca < cb : a < b;
                   });
  build(begin, middle, centers);
  nodes_[self].first = static_cast<std::int32_t>(nodes_.size());
  nodes_[self].count = 0;
  build(middle, end, centers);
}

NearestPoint MeshTree::nearest(const glm::vec3& point, float bound, int hint) const {
  NearestPoint best;
  float best_squared = bound * bound;
  const auto offer = [&](std::int32_t triangle) {
    const Corners& t = corners_[triangle];
    const glm::vec3 candidate = nearest_on_triangle(point, t.a, t.b, t.c);
    const glm::vec3 way = candidate - point;
    const float squared = glm::dot(way, way);
    if (squared < best_squared) {
      best_squared = squared;
      best.point = candidate;
      best.triangle = triangle;
    }
  };
  if (nodes_.empty()) return best;
  if (hint >= 0) offer(hint);
  struct Entry {
    std::int32_t node;
    float squared;
  };
  Entry stack[128];  // depth is at most log2 of the triangle count, since builds halve
  int top = 0;
  stack[top++] = {0, squared_distance_to_box(point, nodes_[0].low, nodes_[0].high)};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.squared >= best_squared) continue;
    const Node& node = nodes_[entry.node];
    if (node.count > 0) {
      for (std::int32_t i = node.first; i < node.first + node.count; ++i) offer(order_[i]);
      continue;
    }
    Entry left{entry.node + 1, 0.0f};
    Entry right{node.first, 0.0f};
    left.squared = squared_distance_to_box(point, nodes_[left.node].low, nodes_[left.node].high);
    right.squared = squared_distance_to_box(point, nodes_[right.node].low, nodes_[right.node].high);
    if (left.squared < right.squared) std::swap(left, right);
    stack[top++] = left;
    stack[top++] = right;
  }
  if (best.triangle >= 0) best.distance = std::sqrt(best_squared);
  return best;
}

void MeshTree::each_hit(const glm::vec3& origin, const glm::vec3& direction,
                        const std::function<void(float, int)>& hit) const {
  if (nodes_.empty()) return;
  const glm::vec3 inverse = 1.0f / direction;
  std::int32_t stack[128];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::int32_t index = stack[--top];
    const Node& node = nodes_[index];
    if (!ray_meets_box(origin, inverse, node.low, node.high)) continue;
    if (node.count == 0) {
      stack[top++] = index + 1;
      stack[top++] = node.first;
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      // Möller–Trumbore, in double: parity must not depend on rounding near an edge.
      const Corners& t = corners_[order_[i]];
      const glm::dvec3 edge1 = glm::dvec3(t.b) - glm::dvec3(t.a);
      const glm::dvec3 edge2 = glm::dvec3(t.c) - glm::dvec3(t.a);
      const glm::dvec3 p = glm::cross(glm::dvec3(direction), edge2);
      const double determinant = glm::dot(edge1, p);
      if (determinant == 0.0) continue;
      const glm::dvec3 s = glm::dvec3(origin) - glm::dvec3(t.a);
      const double u = glm::dot(s, p) / determinant;
      if (u < 0.0 || u > 1.0) continue;
      const glm::dvec3 q = glm::cross(s, edge1);
      const double v = glm::dot(glm::dvec3(direction), q) / determinant;
      if (v < 0.0 || u + v > 1.0) continue;
      const double along = glm::dot(edge2, q) / determinant;
      if (along > 0.0) hit(static_cast<float>(along), order_[i]);
    }
  }
}

bool MeshTree::inside(const glm::vec3& point) const {
  static const glm::vec3 kDirections[3] = {glm::normalize(glm::vec3(0.8142f, 0.3371f, 0.4727f)),
                                           glm::normalize(glm::vec3(-0.2913f, 0.9011f, -0.3219f)),
                                           glm::normalize(glm::vec3(-0.3719f, -0.4391f, 0.8177f))};
  int votes = 0;
  for (const glm::vec3& direction : kDirections) {
    int winding = 0;
    each_hit(point, direction, [&](float, int triangle) {
      winding += glm::dot(face_normal(triangle), direction) > 0.0f ? 1 : -1;
    });
    votes += winding > 0 ? 1 : 0;
  }
  return votes >= 2;
}

glm::vec3 MeshTree::face_normal(int triangle) const {
  const Corners& t = corners_[triangle];
  const glm::dvec3 normal = glm::cross(glm::dvec3(t.b) - glm::dvec3(t.a), glm::dvec3(t.c) - glm::dvec3(t.a));
  const double length = glm::length(normal);
  return length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0f, 1.0f, 0.0f);
}

}  // namespace slosh::mesh
