#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "render/read_back.h"
#include "render/renderer_parts.h"

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

}  // namespace

RenderOptions section_five(RenderOptions options) {
  options.surface = Surface::kPaper;
  options.bilateral_iterations = 4;
  options.splat_scale = 1.2f;
  options.half_resolution_back = true;
  options.body_reflections = options.caustics = false;
  options.fresnel = options.lit_fluid = options.layers = options.fluid_shadow = options.soft_mixing = false;
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

void Renderer::remove_mesh(MeshHandle mesh) {
  parts_->meshes.remove(mesh);
}

TextureHandle Renderer::add_texture(const TextureImage& image) {
  return parts_->textures.add(image);
}

void Renderer::prepare(const Frame& frame, std::span<const View> views) {
  Parts& p = *parts_;
  p.times.clear();
  p.frame = frame;
  p.wet_maps.take(p.frame);
  p.offered_on_gpu = p.offered_on_gpu || frame.on_gpu;
  if (p.options.bridges && p.options.surface == Surface::kOurs && !p.compute)
    p.run("bridges", [&] { p.bridges.add(p.frame); });
  p.shadow = {};
  p.is_stretched = false;
  if (p.shadow_pass && !views.empty()) {
    p.run("shadow map", [&] { p.shadow = p.shadow_pass->draw(p.frame, p.meshes, views); });
  }
  if (p.particles) {
    const bool moves = p.options.surface == Surface::kOurs;
    p.run("particles", [&] { p.particles->take(p.frame, moves); });
    p.run("fluid shadow, cells", [&] {
      const bool dims = p.fluid_shadow_pass->start_sums(p.frame, p.options, p.shadow, *p.particles);
      p.particles->start_next();
      gl::finish_compute();
      if (dims) p.fluid_shadow_pass->start_map();
      p.particles->start_next();
      gl::finish_compute();
    });
  } else {
    p.run("fluid shadow", [&] { p.fluid_shadow_pass->draw(p.frame, p.options, p.shadow); });
  }
  p.uniforms.upload_looks(p.frame.fluids);
  p.centers_sorted = false;
  glFlush();  // a CPU's driver draws the shadows with its own threads meanwhile
}

void Renderer::draw(const View& view, const PictureTarget& target) {
  draw({&view, 1}, {&target, 1});
}

void Renderer::draw(std::span<const View> views, std::span<const PictureTarget> targets) {
  Parts& p = *parts_;
  views = views.first(std::min(views.size(), p.pictures.size()));
  if (views.empty()) return;
  p.draw_together(views);
  for (std::size_t i = 0; i < std::min(views.size(), targets.size()); ++i) {
    if (targets[i].texture == 0) continue;
    p.run("copy", [&] { p.copy(p.pictures[i].targets.display, p.targets.size, targets[i]); });
  }
}

void Renderer::stretch_to(glm::ivec2 size) {
  const bool none = size.x < 1 || size.y < 1;
  parts_->stretched_to = none ? glm::ivec2(0) : glm::min(size, glm::ivec2(kMaxSide));
}

void Renderer::draw_hud(std::size_t view) {
  Parts& p = *parts_;
  const Targets& drawn = p.pictures[std::min<std::size_t>(view, 1)].targets;
  if (drawn.size != p.targets.size) return;
  p.is_stretched = false;
  if (p.stretched_to != glm::ivec2(0) && p.stretched_to != drawn.size) {
    p.run("stretch", [&] { p.stretch(drawn); });
  }
  if (!p.frame.hud) return;
  p.run("hud", [&] {
    if (p.is_stretched) return p.hud_pass->draw(p.frame.hud, p.stretched_target, p.stretched_size);
    p.hud_pass->draw(p.frame.hud, drawn.display_target, drawn.size);
  });
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

Image Renderer::read_back(std::size_t view) {
  if (parts_->is_stretched) return read_image(parts_->stretched_target, parts_->stretched_size);
  const Targets& drawn = parts_->pictures[std::min<std::size_t>(view, 1)].targets;
  return read_image((drawn.size == glm::ivec2(0) ? parts_->targets : drawn).display_target,
                    parts_->targets.size);
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
    case Buffer::kCaustics: {
      FloatImage ratio{t.half_size.x, t.half_size.y, 1, {}};
      const auto pixels = static_cast<std::size_t>(t.half_size.x) * static_cast<std::size_t>(t.half_size.y);
      ratio.values.assign(pixels, 1.0f);
      if (!p.drew_caustics) return ratio;
      const FloatImage sums = read_floats(p.caustics_pass->sums(), t.half_size, 3);
      for (std::size_t i = 0; i < pixels; ++i) {
        if (sums.values[3 * i + 1] > 1e-6f) ratio.values[i] = sums.values[3 * i] / sums.values[3 * i + 1];
      }
      return ratio;
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

bool Renderer::reads_particles_on_gpu() const {
  return parts_->particles && parts_->particles->given().shared();
}

Quality Renderer::quality() const {
  return parts_->fast ? Quality::kFast : Quality::kFull;
}

std::string Renderer::particles_refused() const {
  if (parts_->particles) return parts_->particles->given().refused();
  return parts_->offered_on_gpu ? "particles that lie on the GPU: the picture is not drawn by compute "
                                  "shaders, so they go through main memory"
                                : std::string();
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
