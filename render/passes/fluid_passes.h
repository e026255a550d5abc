// Section 5's fluid: splat, smooth, composite.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/gl/pixel_program.h"
#include "render/passes/particles_on_gpu.h"
#include "render/passes/splats.h"
#include "render/passes/surface_filter.h"
#include "render/passes/targets.h"
#include "render/renderer.h"

namespace slosh {

/// What a lit composite has compiled in beside fluid_look.glsl.
struct LitLook {
  int mixed = 0;          ///< textures that passes/mixing_pass.h bound, with the fluids' shares; 0: no mixing
  bool bodies = false;    ///< they are mirrored
  bool caustics = false;  ///< passes/caustics_pass.h bound them
  auto operator<=>(const LitLook&) const = default;
};

class FluidPasses {
 public:
  /// `compute`: by compute shaders.
  static Result<FluidPasses> create(bool fast, bool compute, const std::vector<std::string>& far_light);

  /// Uploads this frame's splats and tiles.
  void upload(const Splats& splats);
  /// What upload() took.
  const SplatBuffers& splats() const { return splats_; }
  /// 5.1, by fragments. Reads the splats; writes front and back.
  void splat_front(const Targets& targets);
  void splat_back(const Targets& targets);
  /// The filter that smooth() runs. Errors: a shader that the driver refuses.
  Result<bool> choose(Surface surface);
  /// After splat_front(): what the filter needs in main memory. A CPU that draws may then go on with other
  /// passes.
  void fetch_front(const Targets& targets, const RenderOptions& options);
  /// Reads front; writes smooth by turns.
  void smooth(const Targets& targets, const RenderOptions& options, const Frame& frame);
  /// All of this by compute shaders, of splats that were placed there, in steps of which nobody reads before
  /// gl::finish_compute(): front and back cleared; the splats; each turn of the filter, of which
  /// begin_filter() tells how many there are.
  void start_clear(const Targets& targets) const;
  void start_splats(const Targets& targets, const SplatBuffers& splats) const;
  int begin_filter(const RenderOptions& options);
  void start_turn(int i, const Targets& targets, const RenderOptions& options, const Frame& frame);
  /// 5.2: Eq 15, or with `lit` fluid_look.glsl. Reads front, smooth, back, scene_depth, scene_color; writes
  /// color where there is fluid. `look`: null for Eq 15. By compute shaders nobody reads it before
  /// gl::finish_compute().
  void start_composite(const Targets& targets, const LitLook* look);
  /// T for tests, into an R32F target of the picture's size; and n, into an RGBA32F one.
  void thickness(const Targets& targets, const gl::Framebuffer& target);
  void normals(const Targets& targets, const gl::Framebuffer& target);

  /// F_fD after the last smooth(), or before it if no iteration was asked for.
  const gl::Texture& smoothed(const Targets& targets) const;

 private:
  /// By one of which splats are drawn.
  struct SplatProgram {
    gl::Program triangles;
    gl::RowProgram rows;  ///< for compute
    static Result<SplatProgram> create(bool compute, const std::vector<std::string>& defines);
  };
  /// Splats of `buffer` into a cleared texture of depths, by blending.
  void splat(const gl::Program& program, const gl::Framebuffer& target, glm::ivec2 size, GLenum blending,
             float cleared, const gl::StreamBuffer& buffer, std::size_t count);
  /// Made when first asked for.
  const gl::PixelProgram& program_of(const LitLook& look, const Targets& targets);
  gl::TileDraw tiles() const { return {&tile_vertices_, tile_corners_}; }
  void upload_tiles(std::span<const glm::vec2> corners);
  void use_whole_picture();
  void draw_data(const gl::Program& program, const Targets& targets, const gl::Framebuffer& target);

  SplatProgram front_program_;
  SplatProgram shaped_program_;  ///< front of splats with shapes
  SplatProgram back_program_;
  gl::PixelProgram composite_program_;
  gl::PixelProgram look_program_;  ///< of LitLook{}
  std::map<LitLook, gl::PixelProgram> more_look_programs_;
  std::vector<std::string> look_defines_;
  gl::PixelProgram fill_program_;  ///< for compute
  gl::Program thickness_program_;
  gl::Program normal_program_;
  SplatBuffers splats_;  ///< in front
  gl::StreamBuffer back_buffer_;
  gl::StreamBuffer tile_buffer_;
  gl::VertexArray no_vertices_;
  gl::VertexArray tile_vertices_;
  std::size_t back_count_ = 0;
  GLsizei tile_corners_ = 0;
  bool fast_ = false;
  bool compute_ = false;
  Surface surface_ = Surface::kOurs;
  std::unique_ptr<SurfaceFilter> filter_;
  int smoothed_ = -1;  ///< index into Targets::smooth, −1 = front
};

}  // namespace slosh
