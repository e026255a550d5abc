// Writing a scene as glTF, through tinygltf: nodes, physics in extras, animation, camera.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "scenes/make/solid.h"
#include "sim/math/pose.h"
#include "sim/math/texture_sampling.h"

// Not its header, which every scene would read.
namespace tinygltf {
class Model;
}

namespace slosh::make {

/// A texture of a Paint: an image of add_image, how it is read beyond its edges and between its texels.
struct PaintMap {
  int image = -1;  ///< none
  TextureSampling sampling;
};

struct Paint {
  glm::dvec4 color{0.7, 0.7, 0.7, 1.0};  ///< linear; alpha below 1 is blended
  double metallic = 0.0;
  double roughness = 0.6;
  glm::dvec3 emissive{0.0};
  PaintMap base_color_map{}, metallic_roughness_map{}, normal_map{}, occlusion_map{}, emissive_map{};
  double normal_scale = 1.0;
  double occlusion_strength = 1.0;
};

class SceneWriter {
 public:
  /// Properties of the whole scene (scenes/FIELDS.md).
  explicit SceneWriter(const nlohmann::json& scene_extras);
  ~SceneWriter();
  SceneWriter(SceneWriter&&) noexcept;
  SceneWriter& operator=(SceneWriter&&) noexcept;

  /// `bytes`: a PNG or a JPEG; it goes into the file's buffer.
  int add_image(const std::string& name, std::span<const std::uint8_t> bytes);
  int add_material(const std::string& name, const Paint& paint);
  int add_mesh(const std::string& name, const Solid& solid, int material);
  /// The same of triangles with normals, and with texture coordinates where there are any.
  int add_mesh(const std::string& name, const TriangleMesh& triangles, int material);
  /// `mesh` −1 makes an empty; `parent` −1 a root.
  int add_node(const std::string& name, int mesh, const Pose& pose, const nlohmann::json& extras,
               int parent = -1);
  /// A hand: an empty that holds `grip` and follows `pose_at` (world) from 0 to `duration`, keyed at `rate`
  /// Hz.
  void add_hand(const std::string& name, const std::string& grip, const std::function<Pose(double)>& pose_at,
                double duration, double rate = 60.0);
  /// Keys of a node without parent, a driven body's: as a hand's.
  void animate(int node, const std::function<Pose(double)>& pose_at, double duration, double rate = 60.0);
  void add_camera(const glm::dvec3& eye, const glm::dvec3& target, double vertical_fov_deg);

  /// One self-contained file: .glb when the name ends so, else .gltf with the buffer inside. False on
  /// failure.
  bool write(const std::filesystem::path& file);

 private:
  int add_view(std::span<const std::uint8_t> bytes, int target);
  int add_texture(const PaintMap& map);
  int add_accessor(const std::vector<float>& numbers, int components, bool with_bounds, int target);

  std::unique_ptr<tinygltf::Model> model_;
};

}  // namespace slosh::make
