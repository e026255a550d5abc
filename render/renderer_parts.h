// What a Renderer is made of: its passes, its targets, and the frame it draws.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/gl/objects.h"
#include "render/gl/pixel_program.h"
#include "render/passes/arrow_pass.h"
#include "render/passes/bridges.h"
#include "render/passes/caustics_pass.h"
#include "render/passes/display_pass.h"
#include "render/passes/far_light.h"
#include "render/passes/fluid_passes.h"
#include "render/passes/fluid_shadow_pass.h"
#include "render/passes/foam_pass.h"
#include "render/passes/frame_block.h"
#include "render/passes/hud_pass.h"
#include "render/passes/kept_picture.h"
#include "render/passes/meshes.h"
#include "render/passes/mixing_pass.h"
#include "render/passes/particles_on_gpu.h"
#include "render/passes/pass_timer.h"
#include "render/passes/scene_pass.h"
#include "render/passes/shadow_pass.h"
#include "render/passes/smooth_centers.h"
#include "render/passes/splats.h"
#include "render/passes/targets.h"
#include "render/passes/textures.h"
#include "render/passes/thickness_pass.h"
#include "render/passes/wet_maps.h"
#include "render/renderer.h"

namespace slosh {

/// How far ambient occlusion looks, in multiples of the distance to what is looked at.
inline constexpr float kOcclusionReach = 0.06f;

/// What a view has for itself. The first one's serves all that are drawn alone.
struct Picture {
  View view;
  Targets targets;
  // Where compute shaders draw:
  gl::StreamBuffer block;  ///< uniforms
  SplatBuffers splats;
  ThicknessPass::Sums chord_sums;
  TiledMeshes::Lists meshes;
};

struct Renderer::Parts {
  Parts(Context& where, const RenderOptions& what);

  Context& context;
  RenderOptions options;
  MeshStore meshes;
  TextureStore textures;
  WetMaps wet_maps;
  FrameUniforms uniforms;
  std::array<Picture, 2> pictures;  ///< of the views drawn together last
  Targets& targets = pictures[0].targets;
  Splats splats;
  Bridges bridges;
  SmoothCenters centers;
  std::optional<ParticlesOnGpu> particles;  ///< for compute
  FarLight far_light;
  std::optional<ShadowPass> shadow_pass;
  std::optional<FluidShadowPass> fluid_shadow_pass;
  std::optional<ScenePass> scene_pass;
  std::optional<FluidPasses> fluid_passes;
  std::optional<ThicknessPass> thickness_pass;
  std::optional<MixingPass> mixing_pass;      ///< made when fluids meet
  std::optional<CausticsPass> caustics_pass;  ///< made when first asked for
  bool drew_caustics = false;                 ///< in the last picture
  std::optional<FoamPass> foam_pass;          ///< made when there is foam
  std::optional<ArrowPass> arrow_pass;
  std::optional<DisplayPass> display_pass;
  std::unique_ptr<HudPass> hud_pass;
  Frame frame;        ///< what was prepared, and the view being drawn
  ShadowView shadow;  ///< of this frame
  KeptPicture kept;
  bool centers_sorted = false;
  bool offered_on_gpu = false;  ///< particles, by some frame
  gl::Texture panel;            ///< RGBA8, made when first asked for
  gl::Framebuffer panel_target;
  glm::ivec2 panel_size{0};
  glm::ivec2 stretched_to{0};  ///< 0: pictures are shown as they are
  gl::Texture stretched;       ///< RGBA8, made when first needed
  gl::Framebuffer stretched_target;
  glm::ivec2 stretched_size{0};
  bool is_stretched = false;      ///< what is shown of this frame
  bool drew_fluid = false;        ///< in the last picture
  bool fast = false;              ///< Quality, resolved
  bool made_fast = false;         ///< that of the targets
  bool compute = false;           ///< PixelPasses, resolved
  gl::PixelProgram copy_program;  ///< for compute
  bool timing = false;
  PassTimer timer;
  std::vector<PassTime> times;

  /// Makes what `options` asks for and is not there yet.
  Result<bool> fit_to_options();
  const gl::Texture* fluid_depth(const Targets& of) const {
    return drew_fluid ? &fluid_passes->smoothed(of) : nullptr;
  }
  bool sums_chords() const;
  bool occludes() const { return options.ambient_occlusion && !fast; }
  bool mirrors_bodies() const;
  /// Draws views into as many pictures.
  void draw_together(std::span<const View> views);
  /// By fragments and in main memory.
  void draw_scene();
  /// The same by compute shaders, of several views at once: what does not wait for each other runs side by
  /// side (renderer_stages.cpp).
  void draw_stages(std::span<Picture> drawn);
  void draw_stages_before_fluid(std::span<Picture> drawn, bool tiled);
  void draw_stages_of_fluid(std::span<Picture> drawn, bool chords);
  void draw_stages_of_look(std::span<Picture> drawn, bool tiled);
  void draw_stages_after(std::span<Picture> drawn, bool tiled);
  /// The composite has shares of several fluids or caustics, one after the other for each view.
  bool blends_or_focuses() const;
  /// Makes a picture the one that passes draw.
  void choose(const Picture& picture);
  /// Starts something for each picture, whose view is then the frame's.
  template <class Start>
  void each(std::span<Picture> drawn, Start&& start) {
    for (Picture& picture : drawn) {
      choose(picture);
      start(picture);
    }
  }
  /// The shares of the fluids that are seen, where there are several; the textures they take, 0: none.
  int draw_mixing(const Targets& into, const SplatBuffers& of);
  /// Whether there are caustics in this picture.
  bool draw_caustics(const Targets& into);
  void draw_foam(const Targets& into);
  /// What is left of the splats for a view; whether it has any.
  bool prepare_fluid(bool chords);
  /// What has to be drawn of this picture; nothing where that is all of it.
  std::optional<PixelBox> part_to_draw();
  static void copy(const gl::Texture& from, glm::ivec2 size, const PictureTarget& target);
  /// The picture in the size that it is shown in, to draw a HUD over.
  void stretch(const Targets& from);
  void show_in_window();

  /// Runs one pass, timed if asked.
  template <class Pass>
  void run(const char* name, Pass&& pass) {
    if (timing) timer.begin(name);
    pass();
    if (timing) timer.end();
  }
};

}  // namespace slosh
