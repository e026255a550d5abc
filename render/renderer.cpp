#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include "render/gl/objects.h"
#include "render/passes/arrow_pass.h"
#include "render/passes/display_pass.h"
#include "render/passes/far_light.h"
#include "render/passes/fluid_passes.h"
#include "render/passes/fluid_shadow_pass.h"
#include "render/passes/foam_pass.h"
#include "render/passes/frame_block.h"
#include "render/passes/hud_pass.h"
#include "render/passes/meshes.h"
#include "render/passes/pass_timer.h"
#include "render/passes/pixel_choice.h"
#include "render/passes/scene_pass.h"
#include "render/passes/shadow_pass.h"
#include "render/passes/smooth_centers.h"
#include "render/passes/splats.h"
#include "render/passes/targets.h"
#include "render/passes/textures.h"
#include "render/passes/thickness_pass.h"
#include "render/read_back.h"

namespace slosh {
namespace {

constexpr int kMaxSide = 16384;

std::optional<Error> check(const RenderOptions& o) {
  const auto wrong = [](const char* field, auto value, const char* mend) {
    return Error{std::string("RenderOptions::") + field, std::to_string(value) + " is out of range", mend};
  };
  const auto positive = [](float value) { return std::isfinite(value) && value > 0.0f; };
  if (o.width < 1 || o.width > kMaxSide) return wrong("width", o.width, "Use 1 to 16384 pixels");
  if (o.height < 1 || o.height > kMaxSide) return wrong("height", o.height, "Use 1 to 16384 pixels");
  if (o.bilateral_iterations < 0 || o.bilateral_iterations > 64) {
    return wrong("bilateral_iterations", o.bilateral_iterations, "Use 0 to 64");
  }
  if (!positive(o.bilateral_range))
    return wrong("bilateral_range", o.bilateral_range, "Use a positive number");
  if (!positive(o.splat_scale)) return wrong("splat_scale", o.splat_scale, "Use a positive number");
  if (!positive(o.exposure)) return wrong("exposure", o.exposure, "Use a positive number");
  if (o.shadow_size < 0 || o.shadow_size > 8192)
    return wrong("shadow_size", o.shadow_size, "Use 0 to 8192 texels");
  return std::nullopt;
}

/// How far ambient occlusion looks, in multiples of the distance to what is looked at.
constexpr float kOcclusionReach = 0.06f;

}  // namespace

namespace {

/// A processor that draws, too, has its hands full; beside a GPU a quarter of its cores is free for this.
int smoothing_threads(const Context& context) {
  return context.is_software() ? 1
                               : std::clamp(static_cast<int>(std::thread::hardware_concurrency()) / 4, 1, 4);
}

}  // namespace

struct Renderer::Parts {
  Parts(Context& where, const RenderOptions& what)
      : context(where),
        options(what),
        textures(!where.is_software()),
        centers(smoothing_threads(where)),
        timer(where.is_software()) {}

  Context& context;
  RenderOptions options;
  MeshStore meshes;
  TextureStore textures;
  FrameUniforms uniforms;
  Splats splats;
  SmoothCenters centers;
  FarLight far_light;
  Targets targets;
  std::optional<ShadowPass> shadow_pass;
  std::optional<FluidShadowPass> fluid_shadow_pass;
  std::optional<ScenePass> scene_pass;
  std::optional<FluidPasses> fluid_passes;
  std::optional<ThicknessPass> thickness_pass;
  std::optional<FoamPass> foam_pass;  ///< made when there is foam
  std::optional<ArrowPass> arrow_pass;
  std::optional<DisplayPass> display_pass;
  std::unique_ptr<HudPass> hud_pass;
  Frame frame;        ///< what was prepared, and the view being drawn
  ShadowView shadow;  ///< of this frame
  bool centers_sorted = false;
  gl::Texture panel;  ///< RGBA8, made when first asked for
  gl::Framebuffer panel_target;
  glm::ivec2 panel_size{0};
  bool drew_fluid = false;  ///< in the last picture
  bool fast = false;        ///< Quality, resolved
  bool made_fast = false;   ///< that of the targets
  bool compute = false;     ///< PixelPasses, resolved
  gl::PixelProgram copy_program;  ///< for compute
  bool timing = false;
  PassTimer timer;
  std::vector<PassTime> times;

  /// Makes what `options` asks for and is not there yet.
  Result<bool> fit_to_options();
  const gl::Texture* fluid_depth() const { return drew_fluid ? &fluid_passes->smoothed(targets) : nullptr; }
  void draw_scene();
  static void copy(const gl::Texture& from, glm::ivec2 size, const PictureTarget& target) {
    glCopyImageSubData(from.name(), GL_TEXTURE_2D, 0, 0, 0, 0, target.texture, GL_TEXTURE_2D, 0, 0, 0, 0,
                       size.x, size.y, 1);
  }
  void show_in_window();

  /// Runs one pass, timed if asked.
  template <class Pass>
  void run(const char* name, Pass&& pass) {
    if (timing) timer.begin(name);
    pass();
    if (timing) timer.end();
  }
};

Result<bool> Renderer::Parts::fit_to_options() {
  const bool want_fast =
      options.quality == Quality::kAuto ? context.is_software() : options.quality == Quality::kFast;
  const bool want_compute = options.pixel_passes == PixelPasses::kMeasured
                                ? compute_is_quicker(context)
                                : options.pixel_passes == PixelPasses::kCompute;
  if (!scene_pass || want_fast != fast || want_compute != compute || !far_light.shows(options.environment)) {
    FarLight light;
    light.choose(options.environment);
    auto arrows = ArrowPass::create(light.defines());
    if (!arrows) return arrows.error();
    auto scene = ScenePass::create(want_fast, want_compute, light.defines());
    if (!scene) return scene.error();
    auto fluid = FluidPasses::create(want_fast, want_compute, light.defines());
    if (!fluid) return fluid.error();
    auto fluid_shadow = FluidShadowPass::create(want_fast, want_compute);
    if (!fluid_shadow) return fluid_shadow.error();
    auto thickness = ThicknessPass::create(want_compute);
    if (!thickness) return thickness.error();
    auto copying = gl::PixelProgram::create("copy.frag", want_compute);
    if (!copying) return copying.error();
    copy_program = std::move(copying.value());
    thickness_pass = std::move(thickness.value());
    arrow_pass = std::move(arrows.value());
    foam_pass.reset();
    far_light = std::move(light);
    scene_pass = std::move(scene.value());
    fluid_shadow_pass = std::move(fluid_shadow.value());
    fluid_passes = std::move(fluid.value());
    drew_fluid = false;
    fast = want_fast;
    compute = want_compute;
  }
  if (auto chosen = fluid_passes->choose(options.surface); !chosen) return chosen.error();
  const glm::ivec2 size(options.width, options.height);
  const glm::ivec2 back = options.half_resolution_back ? (size + 1) / 2 : size;
  if (targets.size != size || targets.back_size != back || made_fast != fast) {
    made_fast = fast;
    targets = make_targets(size, options.half_resolution_back, fast);
    drew_fluid = false;
  }
  const int shadow_size = fast ? (3 * options.shadow_size + 3) / 4 : options.shadow_size;
  if (shadow_size == 0) {
    shadow_pass.reset();
  } else if (!shadow_pass || shadow_pass->size() != shadow_size) {
    auto pass = ShadowPass::create(shadow_size);
    if (!pass) return pass.error();
    shadow_pass = std::move(pass.value());
  }
  if (!display_pass || !display_pass->shows(options.display, options.color, compute)) {
    auto pass = DisplayPass::create(options.display, options.color, compute);
    if (!pass) return pass.error();
    display_pass = std::move(pass.value());
  }
  return true;
}

void Renderer::Parts::show_in_window() {
  const glm::ivec2 window = context.framebuffer_size();
  if (window.x < 1 || window.y < 1) return;
  glBlitNamedFramebuffer(targets.display_target.name(), 0, 0, 0, targets.size.x, targets.size.y, 0, 0,
                         window.x, window.y, GL_COLOR_BUFFER_BIT,
                         window == targets.size ? GL_NEAREST : GL_LINEAR);
}

RenderOptions section_five(RenderOptions options) {
  options.surface = Surface::kPaper;
  options.bilateral_iterations = 4;
  options.splat_scale = 1.2f;
  options.half_resolution_back = true;
  options.fresnel = options.lit_fluid = options.layers = options.fluid_shadow = false;
  options.antialias = options.dither = false;
  return options;
}

Renderer::Renderer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(Context& context, const RenderOptions& options) {
  if (auto wrong = check(options)) return *wrong;
  auto parts = std::make_unique<Parts>(context, options);
  auto hud = HudPass::create(context);
  if (!hud) return hud.error();
  parts->hud_pass = std::move(hud.value());
  if (auto fitted = parts->fit_to_options(); !fitted) return fitted.error();
  return std::unique_ptr<Renderer>(new Renderer(std::move(parts)));
}

MeshHandle Renderer::add_mesh(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                              std::span<const glm::uvec3> triangles, std::span<const glm::vec2> texcoords) {
  return parts_->meshes.add(positions, normals, triangles, texcoords);
}

TextureHandle Renderer::add_texture(const TextureImage& image) {
  return parts_->textures.add(image);
}

void Renderer::prepare(const Frame& frame, std::span<const View> views) {
  Parts& p = *parts_;
  p.times.clear();
  p.frame = frame;
  p.shadow = {};
  if (p.shadow_pass && !views.empty()) {
    p.run("shadow map", [&] { p.shadow = p.shadow_pass->draw(p.frame, p.meshes, views); });
  }
  p.run("fluid shadow", [&] { p.fluid_shadow_pass->draw(p.frame, p.options, p.shadow); });
  p.uniforms.upload_looks(p.frame.fluids);
  p.centers_sorted = false;
  glFlush();  // a CPU's driver draws the shadows with its own threads meanwhile
}

void Renderer::draw(const View& view, const PictureTarget& target) {
  Parts& p = *parts_;
  p.frame.view = view;
  p.draw_scene();
  if (target.texture != 0) {
    p.run("copy", [&] { p.copy(p.targets.display, p.targets.size, target); });
  }
}

void Renderer::Parts::draw_scene() {
  const bool chords = options.layers && options.surface != Surface::kPaper && any_fluid_is_clear(frame);
  far_light.bind();
  uniforms.upload(make_frame_block(frame, options, shadow, chords));
  run("prepare splats", [&] {
    prepare_splats(frame, options, splats);
    if (chords) splats.all = splats.spheres;
    if (fast) leave_out_hidden(frame, options, splats);
    drew_fluid = !splats.empty();
    const bool moves = options.surface == Surface::kOurs && drew_fluid;
    const bool anew = moves && !std::exchange(centers_sorted, true);
    if (anew) centers.sort(frame);
    if (moves && !compute) centers.move(frame, splats);
    if (drew_fluid) fluid_passes->upload(splats);
    if (moves && compute) fluid_passes->smooth_centers(centers, frame.particle_radius, anew);
  });
  if (drew_fluid) {
    run("front depth", [&] { fluid_passes->splat_front(targets); });
    run("fetch front", [&] { fluid_passes->fetch_front(targets, options); });
    run("back depth", [&] { fluid_passes->splat_back(targets); });
  }

  const bool occlusion = options.ambient_occlusion && !fast;
  run("opaque meshes",
      [&] { scene_pass->draw_opaque(frame, meshes, textures, targets, options.draw_background, occlusion); });
  if (occlusion) {
    run("occlusion", [&] { scene_pass->draw_occlusion(targets, kOcclusionReach); });
    run("resolve", [&] { scene_pass->resolve_occlusion(targets); });
  }
  if (drew_fluid) {
    // A CPU's driver draws the passes before with its own threads while a filter in main memory works.
    glFlush();
    run("surface filter", [&] { fluid_passes->smooth(targets, options, frame); });
  }
  if (drew_fluid && chords) {
    run("thickness", [&] { thickness_pass->draw(frame, targets, splats.all); });
  }
  const bool translucent = has_translucent(frame);
  if (drew_fluid) {
    if (translucent && !fast) {
      run("translucent behind",
          [&] { scene_pass->draw_translucent(frame, meshes, textures, targets, fluid_depth(), true); });
    }
    run("copy scene colour", [&] {
      if (compute) {
        gl::bind_textures({&targets.color});
        copy_program.run({targets.scene_color, targets.scene_color_target, targets.size, GL_RGBA16F});
        return;
      }
      glCopyImageSubData(targets.color.name(), GL_TEXTURE_2D, 0, 0, 0, 0, targets.scene_color.name(),
                         GL_TEXTURE_2D, 0, 0, 0, 0, targets.size.x, targets.size.y, 1);
    });
    run("composite", [&] { fluid_passes->composite(targets, options.lit_fluid); });
  }
  if (!frame.foam.empty()) {
    if (!foam_pass) {
      if (auto made = FoamPass::create(far_light.defines())) foam_pass = std::move(made.value());
    }
    if (foam_pass) run("foam", [&] { foam_pass->draw(frame, targets, fluid_depth()); });
  }
  if (translucent) {
    run("translucent",
        [&] { scene_pass->draw_translucent(frame, meshes, textures, targets, fluid_depth(), false); });
  }
  if (!frame.arrows.empty()) {
    run("arrows", [&] { arrow_pass->draw(frame, targets, fluid_depth()); });
  }
  run("display", [&] { display_pass->draw(targets, options.exposure, options.dither, options.antialias); });
  if (options.antialias) {
    run("edges", [&] { display_pass->smooth_edges(targets, context.is_software()); });
  }
}

void Renderer::draw_hud() {
  Parts& p = *parts_;
  if (!p.frame.hud) return;
  p.run("hud", [&] { p.hud_pass->draw(p.frame.hud, p.targets.display_target, p.targets.size); });
}

void Renderer::draw_panel(glm::ivec2 size, const PictureTarget& target) {
  Parts& p = *parts_;
  size = glm::clamp(size, glm::ivec2(1), glm::ivec2(kMaxSide));
  p.run("panel", [&] {
    if (!p.panel || p.panel_size != size) {
      p.panel = gl::make_texture(size, GL_RGBA8, GL_LINEAR);
      p.panel_target = gl::make_framebuffer({&p.panel});
      p.panel_size = size;
    }
    const glm::vec4 transparent(0.0f);
    glClearNamedFramebufferfv(p.panel_target.name(), GL_COLOR, 0, &transparent.x);
    if (p.frame.hud) p.hud_pass->draw(p.frame.hud, p.panel_target, size);
    p.copy(p.panel, size, target);
  });
}

void Renderer::present() {
  Parts& p = *parts_;
  if (p.context.has_window()) {
    p.run("window", [&] { p.show_in_window(); });
  }
  if (p.timing) p.times = p.timer.take();
}

void Renderer::draw(const Frame& frame) {
  prepare(frame, {&frame.view, 1});
  draw(frame.view);
  draw_hud();
  present();
  parts_->frame = {};  // what it points to may go now
}

Image Renderer::read_back() {
  return read_image(parts_->targets.display_target, parts_->targets.size);
}

FloatImage Renderer::read_buffer(Buffer buffer) {
  Parts& p = *parts_;
  const Targets& t = p.targets;
  const auto no_fluid = [&](float value) {
    const auto pixels = static_cast<std::size_t>(t.size.x) * static_cast<std::size_t>(t.size.y);
    return FloatImage{t.size.x, t.size.y, 1, std::vector<float>(pixels, value)};
  };
  switch (buffer) {
    case Buffer::kSceneDepth:
      return read_floats(t.scene_depth, t.size, 1);
    case Buffer::kSceneColor:
      return read_floats(p.drew_fluid ? t.scene_color : t.color, t.size, 3);
    case Buffer::kFinalColor:
      return read_floats(t.color, t.size, 3);
    case Buffer::kFrontDepth:
      return p.drew_fluid ? read_floats(t.front, t.size, 1) : no_fluid(kNoFluidDepth);
    case Buffer::kSmoothDepth:
      return p.drew_fluid ? read_floats(p.fluid_passes->smoothed(t), t.size, 1) : no_fluid(kNoFluidDepth);
    case Buffer::kBackDepth:
      return p.drew_fluid ? read_floats(t.back, t.back_size, 1) : no_fluid(0.0f);
    case Buffer::kThickness: {
      if (!p.drew_fluid) return no_fluid(0.0f);
      const gl::Texture texture = gl::make_texture(t.size, GL_R32F, GL_NEAREST);
      p.fluid_passes->thickness(t, gl::make_framebuffer({&texture}));
      return read_floats(texture, t.size, 1);
    }
    case Buffer::kNormal: {
      const gl::Texture texture = gl::make_texture(t.size, GL_RGBA32F, GL_NEAREST);
      const gl::Framebuffer target = gl::make_framebuffer({&texture});
      const glm::vec4 none(0.0f);
      glClearNamedFramebufferfv(target.name(), GL_COLOR, 0, &none.x);
      if (p.drew_fluid) p.fluid_passes->normals(t, target);
      return read_floats(texture, t.size, 3);
    }
    case Buffer::kFluidIndex:
      return p.drew_fluid ? fluid_indices(read_floats(t.front, t.size, 1)) : no_fluid(-1.0f);
  }
  return {};
}

const RenderOptions& Renderer::options() const {
  return parts_->options;
}

Result<bool> Renderer::set_options(const RenderOptions& options) {
  if (auto wrong = check(options)) return *wrong;
  const RenderOptions old = std::exchange(parts_->options, options);
  auto fitted = parts_->fit_to_options();
  if (!fitted) parts_->options = old;
  return fitted;
}

bool Renderer::on_compute() const {
  return parts_->compute;
}

void Renderer::resize(int width, int height) {
  RenderOptions wanted = parts_->options;
  wanted.width = std::clamp(width, 1, kMaxSide);
  wanted.height = std::clamp(height, 1, kMaxSide);
  (void)set_options(wanted);  // only the size changed, and it is within range
}

void Renderer::set_timing(bool on) {
  parts_->timing = on;
}
const std::vector<PassTime>& Renderer::pass_times() const {
  return parts_->times;
}

}  // namespace slosh
