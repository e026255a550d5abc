// A frame drawn in OpenGL ES 3.0 by the shader files' texts in that dialect, pass by pass as the renderer
// draws it by fragments at full quality: what a spectator's program would do.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/frame.h"
#include "render/image.h"
#include "render/renderer.h"

namespace slosh::es {

/// Keeps meshes, in place of a renderer's.
class KeptMeshes : public MeshSink {
 public:
  struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::uvec3> triangles;
  };
  MeshHandle add_mesh(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                      std::span<const glm::uvec3> triangles, std::span<const glm::vec2>) override;
  TextureHandle add_texture(const TextureImage&) override { return kNoTexture; }

  std::vector<Mesh> meshes;
};

/// What a renderer is to draw with so that its picture is the one here.
RenderOptions options_in_es(RenderOptions options);

struct EsPicture {
  Image shown;                   ///< rows from the top down
  std::vector<glm::vec4> light;  ///< scene-linear, rows from the bottom up
  std::vector<float> surface;    ///< smoothed depths, m, likewise
};

/// In the context that is current. `frame`'s meshes are `kept`'s, by their handles. Nothing, with why in
/// `log`: a program that the driver refuses, or no float pictures.
std::optional<EsPicture> draw_in_es(const Frame& frame, const RenderOptions& options, const KeptMeshes& kept,
                                    std::string& log);

}  // namespace slosh::es
