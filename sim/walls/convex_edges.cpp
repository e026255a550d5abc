#include "sim/walls/convex_edges.h"

#include <algorithm>

namespace slosh {
namespace {

// Spacings: the layer's depth, a sample's own distance from the edge, and how far apart those of the other
// faces are. With 1.5 one of some 1500 of boxes' samples does not see a corner's third face.
constexpr float kReach = 1.75f;
// Of the reach. What is farther before a face than that belongs to a face that meets it in a concave edge.
constexpr float kConcave = 0.033f;
constexpr float kSameFace = 0.85f;   // cosine between normals
constexpr int kMaxIterations = 20;   // iterations over all faces; two at right angles take one
constexpr float kSatisfied = 0.02f;  // of the depth

}  // namespace

ConvexEdges::ConvexEdges(const SurfaceSamples& surface, float spacing)
    : surface_(surface), reach_(kReach * spacing), samples_(reach_) {
  for (const glm::vec3& p : surface.positions) samples_.add(p);
}

std::optional<glm::vec3> ConvexEdges::behind(std::size_t i, float depth) const {
  const Face own{surface_.positions[i], surface_.normals[i]};
  std::vector<Face> faces{own};
  bool concave = false;
  samples_.around(own.at, [&](const glm::vec3& at, std::uint32_t number) {
    const glm::vec3 way = at - own.at;
    if (glm::length(way) > reach_) return;
    const glm::vec3& normal = surface_.normals[number];
    concave |= std::max(glm::dot(way, own.normal), -glm::dot(way, normal)) > kConcave * reach_;
    const bool known = std::any_of(faces.begin(), faces.end(),
                                   [&](const Face& f) { return glm::dot(f.normal, normal) > kSameFace; });
    if (!known) faces.push_back({at, normal});
  });
  if (concave || faces.size() == 1) return std::nullopt;
  glm::vec3 p = own.at - depth * own.normal;
  for (int turn = 0; turn < kMaxIterations; ++turn) {
    float most = 0.0f;
    for (const Face& f : faces) {
      const float missing = depth - glm::dot(f.normal, f.at - p);
      most = std::max(most, missing);
      if (missing > 0.0f) p -= missing * f.normal;
    }
    if (most < kSatisfied * depth) return p;
  }
  return std::nullopt;
}

}  // namespace slosh
