// The meshes: opaque ones before the fluid, translucent ones round it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/frame.h"
#include "render/gl/pixel_program.h"
#include "render/passes/meshes.h"
#include "render/passes/targets.h"
#include "render/passes/textures.h"
#include "render/passes/tiled_meshes.h"
#include "render/passes/wet_maps.h"
#include "render/renderer.h"

namespace slosh {

class ScenePass {
 public:
  /// `compute`: occlusion by compute shaders, and meshes that suit them.
  static Result<ScenePass> create(bool fast, bool compute, const std::vector<std::string>& far_light);

  /// By fragments. Reads opaque meshes and the shadow map; writes S_d, the depth buffer and the colour
  /// (mesh_color if occlusion follows, else color).
  void draw_opaque(const Frame& frame, const MeshStore& meshes, const TextureStore& textures,
                   const WetMaps& wet, const Targets& targets, bool background, bool occlusion_follows);
  /// Whether this frame's meshes go by tiles: then all of them, for each of its views, by what follows;
  /// nobody reads any of it before gl::finish_compute(). All views' looks first, which sorts each one's
  /// meshes, then a view's lists.
  bool takes_tiles(const Frame& frame, const MeshStore& meshes, const TextureStore& textures) const;
  static void upload_looks(const Frame& frame, const MeshStore& meshes, TiledMeshes::Lists& lists);
  void start_lists(const Frame& frame, const MeshStore& meshes, TiledMeshes::Lists& lists) const;
  void start_opaque(const Frame& frame, const TiledMeshes::Lists& lists, const Targets& targets,
                    bool background, bool occlusion_follows) const;
  void start_translucent(const Frame& frame, const TiledMeshes::Lists& lists, const Targets& targets,
                         const gl::Texture* fluid, GlassPart part) const;
  /// Reads S_d; writes occlusion. Reads it and mesh_color; writes color. By compute shaders nobody reads
  /// either before gl::finish_compute().
  void start_occlusion(const Targets& targets, float reach) const;
  void start_resolve(const Targets& targets) const;
  /// By fragments. Blends translucent meshes into color: those behind the fluid's surface, or those in front
  /// of it. `fluid` is the smoothed F_fD, null without fluid.
  void draw_translucent(const Frame& frame, const MeshStore& meshes, const TextureStore& textures,
                        const Targets& targets, const gl::Texture* fluid, bool behind);

 private:
  /// A mesh's program with what its look has compiled in; made when first asked for.
  struct Programs {
    const char* fragment = "";
    std::vector<std::string> defines;  ///< of all
    std::map<unsigned, gl::Program> by_bits;

    static Result<Programs> create(const char* fragment, std::vector<std::string> defines);
    const gl::Program& of(unsigned bits);
  };

  bool fast_ = false;                 ///< glass: only the sides that face the eye
  std::optional<TiledMeshes> tiled_;  ///< where compute shaders draw
  Programs opaque_;
  gl::Program background_;
  gl::PixelProgram occlusion_;
  gl::PixelProgram resolve_;
  Programs translucent_behind_;
  Programs translucent_front_;
  gl::VertexArray no_vertices_;
};

/// The frame has a mesh that is drawn blended; one that is not.
bool has_translucent(const Frame& frame);
bool has_opaque(const Frame& frame);

}  // namespace slosh
