// Meshes by compute shaders: their triangles are put into eye axes, then every tile of pixels goes through
// those that touch it (shaders/mesh_tiles.glsl). For chips that draw fragments slowly; the picture is that of
// scene_pass to rounding.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/frame.h"
#include "render/gl/objects.h"
#include "render/passes/meshes.h"
#include "render/passes/targets.h"
#include "render/passes/textures.h"

namespace slosh {

/// What the programs of meshes and of glass behind the fluid have compiled in, by fragments and by tiles.
struct MeshDefines {
  std::vector<std::string> opaque;
  std::vector<std::string> behind;
};
MeshDefines mesh_defines(bool fast, const std::vector<std::string>& far_light);

/// Which panes of glass are drawn.
enum class GlassPart : std::uint8_t {
  kBehind,  ///< behind the fluid's surface; color is copied to scene_color, too
  kBefore,  ///< before it
};

class TiledMeshes {
 public:
  using Instances = std::vector<const MeshInstance*>;

  /// Errors carry the driver's log.
  static Result<TiledMeshes> create(bool fast, const std::vector<std::string>& far_light);

  /// The frame's meshes have no maps and are dry, and are not so many triangles that tiles would take long to
  /// go through them.
  static bool suit(const Frame& frame, const MeshStore& meshes, const TextureStore& textures);

  /// Of one kind.
  struct List {
    Instances drawn;  ///< in the order in which they are drawn; the frame's, so only until it is drawn
    gl::StreamBuffer triangles;
    gl::StreamBuffer boxes;        ///< of pixels
    gl::StreamBuffer group_boxes;  ///< of 64 triangles each
    gl::StreamBuffer items;        ///< looks
    int groups = 0;                ///< of 64 triangles, the last of each mesh with fewer
  };
  /// What a view has of them.
  struct Lists {
    List opaque;
    List glass;
  };

  /// Takes a view's meshes and uploads what they look like. For all views before the first start_lists(): an
  /// upload between two views' dispatches holds the second one up.
  static void upload_looks(Instances opaque_nearest_first, Instances glass_farthest_first, Lists& lists);
  /// Fills a view's lists with these. Of this and what follows nobody reads before gl::finish_compute().
  void start_lists(const View& view, const MeshStore& meshes, Lists& lists) const;
  /// Opaque ones: writes S_d and the colour (mesh_color if occlusion follows, else color).
  void start_opaque(const Lists& lists, const View& view, const Targets& targets, bool background,
                    bool occlusion_follows) const;
  /// Glass into color. `fluid` is the smoothed F_fD, null without fluid.
  void start_glass(const Lists& lists, const View& view, const Targets& targets, const gl::Texture* fluid,
                   GlassPart part) const;

 private:
  /// What is seen of a mesh.
  enum class Sides : int { kInside = -1, kBoth = 0, kOutside = 1 };

  void fill(List& list, std::span<const Sides> passes, const View& view, const MeshStore& meshes) const;
  static void start(const gl::Program& program, const List& list, const View& view, glm::ivec2 size);

  bool fast_ = false;  ///< glass: only the sides that face the eye
  gl::Program triangles_;
  gl::Program opaque_;
  gl::Program behind_;
  gl::Program before_;
};

}  // namespace slosh
