#include "peer/output/export/surface_files.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <sstream>

#include "peer/output/export/particle_files.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

/// Builds a document whose arrays lie in one buffer.
class GlbWriter {
 public:
  GlbWriter() {
    model_.asset.version = "2.0";
    model_.asset.generator = "slosh";
    model_.buffers.emplace_back();
    model_.scenes.emplace_back();
    model_.defaultScene = 0;
  }

  /// `lanes` numbers of `component_type` a row. Returns the accessor.
  int add(const void* data, std::size_t rows, int lanes, int component_type, int target) {
    const std::size_t bytes = rows * static_cast<std::size_t>(lanes) * 4;  // both kinds have four bytes
    std::vector<unsigned char>& buffer = model_.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = bytes;
    view.target = target;
    const auto* from = static_cast<const unsigned char*>(data);
    buffer.insert(buffer.end(), from, from + bytes);
    model_.bufferViews.push_back(view);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
    accessor.componentType = component_type;
    accessor.count = rows;
    accessor.type = lanes == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_SCALAR;
    model_.accessors.push_back(accessor);
    return static_cast<int>(model_.accessors.size()) - 1;
  }
  int add_vectors(const std::vector<glm::vec3>& values) {
    return add(values.data(), values.size(), 3, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
  }

  void add_fluid(const FluidSurface& surface, const std::string& name, const glm::vec3& color) {
    tinygltf::Material material;
    material.name = name;
    material.pbrMetallicRoughness.baseColorFactor = {color.x, color.y, color.z, 1.0};
    material.pbrMetallicRoughness.metallicFactor = 0.0;
    material.pbrMetallicRoughness.roughnessFactor = 0.05;
    model_.materials.push_back(material);

    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = static_cast<int>(model_.materials.size()) - 1;
    const int positions = add_vectors(surface.positions);
    glm::vec3 least(std::numeric_limits<float>::infinity());
    glm::vec3 most(-std::numeric_limits<float>::infinity());
    for (const glm::vec3& p : surface.positions) {
      least = glm::min(least, p);
      most = glm::max(most, p);
    }
    tinygltf::Accessor& bounds = model_.accessors[static_cast<std::size_t>(positions)];
    bounds.minValues = {least.x, least.y, least.z};
    bounds.maxValues = {most.x, most.y, most.z};
    primitive.attributes["POSITION"] = positions;
    primitive.attributes["NORMAL"] = add_vectors(surface.normals);
    primitive.attributes["_VELOCITY"] = add_vectors(surface.velocities);
    primitive.attributes["_PRESSURE"] = add(surface.pressures.data(), surface.pressures.size(), 1,
                                            TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
    primitive.indices = add(surface.triangles.data(), 3 * surface.triangles.size(), 1,
                            TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    tinygltf::Mesh mesh;
    mesh.name = name;
    mesh.primitives.push_back(std::move(primitive));
    model_.meshes.push_back(std::move(mesh));
    tinygltf::Node node;
    node.name = name;
    node.mesh = static_cast<int>(model_.meshes.size()) - 1;
    model_.nodes.push_back(std::move(node));
    model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()) - 1);
  }

  std::string write(double time) {
    tinygltf::Value::Object extras;
    extras["time_s"] = tinygltf::Value(time);
    model_.scenes[0].extras = tinygltf::Value(std::move(extras));
    if (model_.buffers[0].data.empty()) model_.buffers.clear();  // glTF has no empty buffers
    std::ostringstream out;
    tinygltf::TinyGLTF writer;
    writer.WriteGltfSceneToStream(&model_, out, false, true);
    return std::move(out).str();
  }

 private:
  tinygltf::Model model_;
};

}  // namespace

std::string surface_as_ply(const SurfaceFrame& surface, const ParticleFrame& frame,
                           const ExportedFluids& fluids) {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  for (const FluidSurface& fluid : surface.fluids) {
    vertices += fluid.positions.size();
    triangles += fluid.triangles.size();
  }
  std::string out = ply_beginning(frame.time, fluids);
  out += format("element vertex %zu\n", vertices);
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "vx", "vy", "vz", "pressure"})
    out += format("property float %s\n", name);
  out +=
      format("property uchar fluid\nelement face %zu\nproperty list uchar uint vertex_indices\nend_header\n",
             triangles);
  out.reserve(out.size() + vertices * 41 + triangles * 13);
  for (const FluidSurface& fluid : surface.fluids) {
    for (std::size_t i = 0; i < fluid.positions.size(); ++i) {
      append_vector(out, z_up(fluid.positions[i]));
      append_vector(out, z_up(fluid.normals[i]));
      append_vector(out, z_up(fluid.velocities[i]));
      append_number(out, fluid.pressures[i]);
      append_number(out, static_cast<std::uint8_t>(fluid.fluid));
    }
  }
  std::uint32_t first = 0;
  for (const FluidSurface& fluid : surface.fluids) {
    for (const glm::uvec3& t : fluid.triangles) {
      append_number(out, std::uint8_t{3});
      for (int corner = 0; corner < 3; ++corner) append_number(out, first + t[corner]);
    }
    first += static_cast<std::uint32_t>(fluid.positions.size());
  }
  return out;
}

std::string surface_as_glb(const SurfaceFrame& surface, const ParticleFrame& frame,
                           const ExportedFluids& fluids) {
  GlbWriter writer;
  for (const FluidSurface& fluid : surface.fluids) {
    if (fluid.positions.empty()) continue;
    writer.add_fluid(fluid, fluids.names[fluid.fluid], fluids.colors[fluid.fluid]);
  }
  return writer.write(frame.time);
}

}  // namespace slosh
