#include "scenes/gltf/meshes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "scenes/gltf/accessor.h"
#include "scenes/gltf/textures.h"

namespace slosh::gltf {
namespace {

/// Triangles of a list, a strip or a fan as glTF 2.0, 3.7.2.1 has them; what collapses in a strip stays.
std::vector<glm::uvec3> triangles_of(const std::vector<std::uint32_t>& indices, int mode) {
  std::vector<glm::uvec3> out;
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    for (std::size_t i = 0; i + 2 < indices.size(); ++i)
      out.emplace_back(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
  } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
    for (std::size_t i = 1; i + 1 < indices.size(); ++i)
      out.emplace_back(indices[i], indices[i + 1], indices[0]);
  } else {
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      out.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
  }
  return out;
}

/// `flat` receives whether each triangle has no normals of its own.
std::optional<Error> append_primitive(const Document& document, const tinygltf::Primitive& primitive,
                                      const std::string& where, TriangleMesh& out, std::vector<bool>& flat) {
  const bool is_list = primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == -1;
  if (!is_list && primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
      primitive.mode != TINYGLTF_MODE_TRIANGLE_FAN) {
    return Error{where, "is not made of triangles (primitive mode " + std::to_string(primitive.mode) + ")",
                 "In Blender, convert to a mesh with faces and export again"};
  }
  const Integers integers = document.quantized ? Integers::kAny : Integers::kNone;
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) return Error{where, "has no POSITION", "Export the file again"};
  const auto positions = read_numbers(document.model, position->second, 3, integers, where + ": POSITION");
  if (!positions) return positions.error();
  const std::size_t count = positions.value().size() / 3;
  std::vector<std::uint32_t> indices(count);
  if (primitive.indices >= 0) {
    auto read = read_indices(document.model, primitive.indices, count, where + ": indices");
    if (!read) return read.error();
    indices = std::move(read.value());
  } else {
    std::iota(indices.begin(), indices.end(), 0u);
  }
  if (is_list && indices.size() % 3 != 0) {
    return Error{where, "has " + std::to_string(indices.size()) + " indices, not a multiple of 3",
                 "Export the file again"};
  }
  const std::vector<glm::uvec3> triangles = triangles_of(indices, primitive.mode);
  if (out.triangles.size() + triangles.size() > kMaxTriangles || count > 3 * kMaxTriangles) {
    return Error{where, "has more than " + std::to_string(kMaxTriangles) + " triangles",
                 "Reduce it, in Blender with the Decimate modifier"};
  }
  const auto base = static_cast<std::uint32_t>(out.positions.size());
  for (std::size_t i = 0; i < count; ++i) {
    const double* p = positions.value().data() + 3 * i;
    out.positions.emplace_back(p[0], p[1], p[2]);
  }
  out.normals.resize(out.positions.size(), glm::vec3(0.0f));
  const auto normal = primitive.attributes.find("NORMAL");
  if (normal != primitive.attributes.end()) {
    const auto normals = read_numbers(document.model, normal->second, 3, integers, where + ": NORMAL");
    if (!normals) return normals.error();
    if (normals.value().size() / 3 != count) {
      return Error{where + ": NORMAL", "has another count than POSITION", "Export the file again"};
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double* n = normals.value().data() + 3 * i;
      out.normals[base + i] = glm::vec3(n[0], n[1], n[2]);
    }
  }
  for (const glm::uvec3& t : triangles) out.triangles.push_back(base + t);
  flat.resize(out.triangles.size(), normal == primitive.attributes.end());
  return std::nullopt;
}

/// Looks alone: coordinates that are missing or cannot be read are (0, 0).
void append_texcoords(const Document& document, const tinygltf::Primitive& primitive, const TexcoordUse& use,
                      TriangleMesh& out) {
  const std::size_t base = out.texcoords.size();
  out.texcoords.resize(out.positions.size(), glm::vec2(0.0f));
  const auto attribute = primitive.attributes.find("TEXCOORD_" + std::to_string(use.set));
  if (attribute == primitive.attributes.end()) return;
  const auto read = read_numbers(document.model, attribute->second, 2,
                                 document.quantized ? Integers::kAny : Integers::kNormalized, "TEXCOORD");
  if (!read || read.value().size() / 2 != out.positions.size() - base) return;
  for (std::size_t i = base; i < out.texcoords.size(); ++i) {
    const double* t = read.value().data() + 2 * (i - base);
    out.texcoords[i] = glm::vec2(glm::clamp(use.linear * glm::dvec2(t[0], t[1]) + use.offset, -1e4, 1e4));
  }
}

/// Gives every vertex without a usable normal the area-weighted mean of its faces.
void mend_normals(TriangleMesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]);
    const glm::dvec3 face =
        glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
    for (int i = 0; i < 3; ++i) sums[t[i]] += face;
  }
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    // A file may hold any number: the length of one that fits a float does not always.
    const glm::dvec3 given(mesh.normals[i]);
    const double length = glm::length(given);
    if (length > 1e-6 && std::isfinite(length)) {
      mesh.normals[i] = glm::vec3(given / length);
    } else {
      const double sum = glm::length(sums[i]);
      mesh.normals[i] = sum > 1e-30 ? glm::vec3(sums[i] / sum) : glm::vec3(0.0f, 1.0f, 0.0f);
    }
  }
}

/// Gives faces without normals their own, and vertices of their own where neighbours face another way.
void shade_flat(TriangleMesh& mesh, const std::vector<bool>& flat) {
  constexpr float kSame = 1.0f - 1e-6f;                       // cosine
  std::vector<std::uint32_t> next(mesh.positions.size(), 0);  // further vertices of the same place; 0 = none
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!flat[i]) continue;
    glm::uvec3& t = mesh.triangles[i];
    const glm::dvec3 a(mesh.positions[t.x]);
    const glm::dvec3 face =
        glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
    if (!(glm::length(face) > 0.0)) continue;
    const glm::vec3 normal(glm::normalize(face));
    for (int corner = 0; corner < 3; ++corner) {
      std::uint32_t at = t[corner];
      while (mesh.normals[at] != glm::vec3(0.0f) && glm::dot(mesh.normals[at], normal) < kSame) {
        if (next[at] == 0) {
          next[at] = static_cast<std::uint32_t>(mesh.positions.size());
          next.push_back(0);
          mesh.positions.push_back(glm::vec3(mesh.positions[at]));
          mesh.normals.emplace_back(0.0f);
          if (!mesh.texcoords.empty()) mesh.texcoords.push_back(glm::vec2(mesh.texcoords[at]));
        }
        at = next[at];
      }
      mesh.normals[at] = normal;
      t[corner] = at;
    }
  }
}

void bake(const glm::dmat3& rest, TriangleMesh& mesh) {
  const glm::dmat3 for_normals = glm::transpose(glm::inverse(rest));
  for (glm::vec3& p : mesh.positions) p = glm::vec3(rest * glm::dvec3(p));
  for (glm::vec3& n : mesh.normals) n = glm::vec3(for_normals * glm::dvec3(n));
  if (glm::determinant(rest) < 0.0) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  }
}

}  // namespace

std::size_t work_of_mesh(const Document& document, int mesh) {
  // One that says more than its view has bytes is not read at all.
  const auto count = [&model = document.model](int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size()) return std::size_t{0};
    const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
    if (accessor.bufferView < 0) return accessor.count;
    if (static_cast<std::size_t>(accessor.bufferView) >= model.bufferViews.size()) return std::size_t{0};
    return std::min(accessor.count,
                    model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteLength);
  };
  std::size_t work = 0;
  for (const tinygltf::Primitive& primitive :
       document.model.meshes[static_cast<std::size_t>(mesh)].primitives) {
    const auto position = primitive.attributes.find("POSITION");
    for (const int accessor :
         {primitive.indices, position == primitive.attributes.end() ? -1 : position->second})
      work += std::min(count(accessor), kMaxNumbersRead + 1);
  }
  return work;
}

Result<TriangleMesh> read_mesh(const Document& document, int mesh, const glm::dmat3& rest,
                               const std::string& where) {
  const tinygltf::Mesh& source = document.model.meshes[mesh];
  TriangleMesh out;
  out.name = source.name.empty() ? std::string("#").append(std::to_string(mesh)) : source.name;
  const std::string who = where + ": mesh '" + out.name + "'";
  const std::optional<TexcoordUse> texcoords =
      read_material_use(document, material_of(document, mesh), nullptr).texcoords();
  std::vector<bool> flat;
  for (const tinygltf::Primitive& primitive : source.primitives) {
    if (const auto problem = append_primitive(document, primitive, who, out, flat)) return *problem;
    if (texcoords) append_texcoords(document, primitive, *texcoords, out);
  }
  if (out.triangles.empty()) return Error{who, "has no triangles", "Give it faces, or take the node out"};
  bake(rest, out);
  for (const glm::vec3& p : out.positions) {
    if (glm::any(glm::greaterThan(glm::abs(p), glm::vec3(kFarthest)))) {
      return Error{who, "reaches further than 10 km", "Work in metres"};
    }
  }
  shade_flat(out, flat);
  mend_normals(out);
  return out;
}

}  // namespace slosh::gltf
