#include "render/passes/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace slosh {
namespace {

struct Vertex {
  glm::vec3 position;
  glm::vec3 normal;
};

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

constexpr std::size_t kMaxConvexWork = 4000000;  // triangles times corners

bool is_convex(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
               const Bounds& bounds) {
  if (triangles.size() * triangles.size() * 3 > kMaxConvexWork) return false;
  const float slack = 1e-4f * glm::length(bounds.high - bounds.low);
  return std::ranges::all_of(triangles, [&](const glm::uvec3& side) {
    const glm::vec3& at = positions[side.x];
    const glm::vec3 across = glm::cross(positions[side.y] - at, positions[side.z] - at);
    const float size = glm::length(across);
    if (size < 1e-12f) return true;  // no area, no plane
    return std::ranges::all_of(triangles, [&](const glm::uvec3& other) {
      for (int k = 0; k < 3; ++k) {
        if (glm::dot(positions[other[k]] - at, across) > slack * size) return false;
      }
      return true;
    });
  });
}

constexpr std::size_t kMaxClosedWork = 16000;  // triangles; more are drawn by fragments, which need not know

/// Corners at one place are one, to a hundred-thousandth of the mesh: those with several normals, and seams.
bool is_closed(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
               const Bounds& bounds) {
  const float step = 1e-5f * glm::length(bounds.high - bounds.low);
  if (!(step > 0.0f) || triangles.size() > kMaxClosedWork) return false;
  using Place = std::array<std::int32_t, 3>;
  const auto place_of = [&](std::uint32_t corner) {
    const glm::vec3 at = glm::round((positions[corner] - bounds.low) / step);
    return Place{static_cast<std::int32_t>(at.x), static_cast<std::int32_t>(at.y),
                 static_cast<std::int32_t>(at.z)};
  };
  std::vector<std::pair<std::pair<Place, Place>, int>> edges;  // the lesser end first; which way
  double volume = 0.0;
  for (const glm::uvec3& triangle : triangles) {
    const glm::dvec3 a(positions[triangle.x] - bounds.low), b(positions[triangle.y] - bounds.low);
    volume += glm::dot(a, glm::cross(b, glm::dvec3(positions[triangle.z] - bounds.low)));
    for (int k = 0; k < 3; ++k) {
      const Place from = place_of(triangle[k]);
      const Place to = place_of(triangle[(k + 1) % 3]);
      if (from < to) edges.push_back({{from, to}, 1});
      if (to < from) edges.push_back({{to, from}, -1});
    }
  }
  std::ranges::sort(edges);
  for (std::size_t i = 0; i < edges.size();) {
    int ways = 0;
    const std::size_t first = i;
    for (; i < edges.size() && edges[i].first == edges[first].first; ++i) ways += edges[i].second;
    if (ways != 0) return false;
  }
  return volume > 0.0;
}

}  // namespace

MeshHandle MeshStore::add(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                          std::span<const glm::uvec3> triangles, std::span<const glm::vec2> texcoords) {
  const auto handle = static_cast<MeshHandle>(meshes_.size());
  Mesh mesh;
  std::vector<Vertex> vertices;
  vertices.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    vertices.push_back({positions[i], i < normals.size() ? normals[i] : glm::vec3(0.0f, 1.0f, 0.0f)});
  }
  std::vector<glm::uvec3> kept;
  kept.reserve(triangles.size());
  for (const glm::uvec3& triangle : triangles) {
    bool good = true;
    for (int k = 0; k < 3; ++k)
      good = good && triangle[k] < positions.size() && finite(positions[triangle[k]]);
    if (!good) continue;
    kept.push_back(triangle);
    for (int k = 0; k < 3; ++k) mesh.bounds.add(positions[triangle[k]]);
  }
  if (!kept.empty()) {
    mesh.vertices = gl::make_buffer();
    mesh.indices = gl::make_buffer();
    mesh.array = gl::make_vertex_array();
    glNamedBufferStorage(mesh.vertices.name(), static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
                         vertices.data(), 0);
    glNamedBufferStorage(mesh.indices.name(), static_cast<GLsizeiptr>(kept.size() * sizeof(glm::uvec3)),
                         kept.data(), 0);
    const GLuint array = mesh.array.name();
    glVertexArrayVertexBuffer(array, 0, mesh.vertices.name(), 0, sizeof(Vertex));
    glVertexArrayElementBuffer(array, mesh.indices.name());
    for (GLuint attribute = 0; attribute < 2; ++attribute) {
      glEnableVertexArrayAttrib(array, attribute);
      glVertexArrayAttribFormat(array, attribute, 3, GL_FLOAT, GL_FALSE, attribute * sizeof(glm::vec3));
      glVertexArrayAttribBinding(array, attribute, 0);
    }
    if (texcoords.size() >= positions.size()) {  // else the shader reads (0, 0)
      glEnableVertexArrayAttrib(array, 2);
      glVertexArrayAttribFormat(array, 2, 2, GL_FLOAT, GL_FALSE, 0);
      glVertexArrayAttribBinding(array, 2, 1);
      mesh.texcoords = gl::make_buffer();
      glNamedBufferStorage(mesh.texcoords.name(), static_cast<GLsizeiptr>(texcoords.size_bytes()),
                           texcoords.data(), 0);
      glVertexArrayVertexBuffer(array, 1, mesh.texcoords.name(), 0, sizeof(glm::vec2));
    }
    mesh.index_count = static_cast<GLsizei>(3 * kept.size());
    mesh.convex = is_convex(positions, kept, mesh.bounds);
    mesh.closed = is_closed(positions, kept, mesh.bounds);
  }
  meshes_.push_back(std::move(mesh));
  return handle;
}

void MeshStore::draw(MeshHandle handle) const {
  const Mesh& mesh = meshes_[handle];
  glBindVertexArray(mesh.array.name());
  glDrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
}

}  // namespace slosh
