#include "render/renderer_parts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "render/passes/window_part.h"

namespace slosh {
Renderer::Parts::Parts(Context& where, const RenderOptions& what)
    : context(where), options(what), textures(!where.is_software()), timer(where.is_software()) {}

void Renderer::Parts::copy(const gl::Texture& from, glm::ivec2 size, const PictureTarget& target) {
  glCopyImageSubData(from.name(), GL_TEXTURE_2D, 0, 0, 0, 0, target.texture, GL_TEXTURE_2D, 0, 0, 0, 0,
                     size.x, size.y, 1);
}

void Renderer::Parts::draw_together(std::span<const View> views) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    Picture& picture = pictures[i];
    picture.view = views[i];
    if (picture.targets.size != targets.size)
      picture.targets = make_targets(targets.size, options.half_resolution_back, fast);
  }
  if (compute) return draw_stages(std::span(pictures).first(views.size()));
  // One after the other into the first one's, which the last stays in.
  for (std::size_t i = views.size(); i-- > 0;) {
    frame.view = views[i];
    draw_scene();
    if (i == 0) continue;
    std::swap(pictures[0].targets, pictures[i].targets);
    kept.forget();
  }
}

Result<bool> Renderer::Parts::fit_to_options() {
  const bool want_fast =
      options.quality == Quality::kAuto ? context.is_software() : options.quality == Quality::kFast;
  const bool want_compute = options.pixel_passes == PixelPasses::kOfMachine
                                ? !context.is_software()
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
    std::optional<ParticlesOnGpu> on_gpu;
    gl::PixelProgram copying;
    if (want_compute) {
      auto taken = ParticlesOnGpu::create();
      if (!taken) return taken.error();
      on_gpu = std::move(taken.value());
      auto made = gl::take(copying, gl::PixelProgram::create("copy.frag", true, false, {"EACH 4"}));
      if (!made) return made.error();
    }
    particles = std::move(on_gpu);
    copy_program = std::move(copying);
    thickness_pass = std::move(thickness.value());
    arrow_pass = std::move(arrows.value());
    foam_pass.reset();
    mixing_pass.reset();
    far_light = std::move(light);
    scene_pass = std::move(scene.value());
    fluid_shadow_pass = std::move(fluid_shadow.value());
    fluid_passes = std::move(fluid.value());
    drew_fluid = false;
    fast = want_fast;
    compute = want_compute;
  }
  kept.forget();
  if (auto chosen = fluid_passes->choose(options.surface); !chosen) return chosen.error();
  const glm::ivec2 size(options.width, options.height);
  const glm::ivec2 back = options.half_resolution_back ? (size + 1) / 2 : size;
  if (targets.size != size || targets.back_size != back || made_fast != fast) {
    made_fast = fast;
    targets = make_targets(size, options.half_resolution_back, fast);
    pictures[1].targets = {};
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
  const DisplayPass::Wish shown{options.display, options.color, options.display_by, compute};
  if (!display_pass || !display_pass->is(shown)) {
    auto pass = DisplayPass::create(shown);
    if (!pass) return pass.error();
    display_pass = std::move(pass.value());
  }
  return true;
}

void Renderer::Parts::stretch(const Targets& from) {
  if (stretched_size != stretched_to) {
    stretched = gl::make_texture(stretched_to, GL_RGBA8, GL_LINEAR);
    stretched_target = gl::make_framebuffer({&stretched});
    stretched_size = stretched_to;
  }
  glBlitNamedFramebuffer(from.display_target.name(), stretched_target.name(), 0, 0, from.size.x, from.size.y,
                         0, 0, stretched_size.x, stretched_size.y, GL_COLOR_BUFFER_BIT, GL_LINEAR);
  is_stretched = true;
}

void Renderer::Parts::show_in_window() {
  const glm::ivec2 window = context.framebuffer_size();
  if (window.x < 1 || window.y < 1) return;
  const gl::Framebuffer& from = is_stretched ? stretched_target : targets.display_target;
  const glm::ivec2 size = is_stretched ? stretched_size : targets.size;
  const PixelBox part = window_part(size, window);
  if (part.size() != window) {
    constexpr float kBlack[] = {0.0f, 0.0f, 0.0f, 1.0f};
    glClearNamedFramebufferfv(0, GL_COLOR, 0, kBlack);
  }
  glBlitNamedFramebuffer(from.name(), 0, 0, 0, size.x, size.y, part.low.x, part.low.y, part.high.x,
                         part.high.y, GL_COLOR_BUFFER_BIT, window == size ? GL_NEAREST : GL_LINEAR);
}

std::optional<PixelBox> Renderer::Parts::part_to_draw() {
  // Edges are smoothed in main memory then, which is where the picture is kept without a HUD.
  if (!options.keep_still || !options.antialias || !fast || !context.is_software()) return std::nullopt;
  return kept.changed(frame, meshes, targets.size, shadow.size > 0 ? shadow.texel : 0.0f);
}

int Renderer::Parts::draw_mixing(const Targets& into, const SplatBuffers& of) {
  if (!options.soft_mixing || !options.lit_fluid) return 0;
  const int layers = compute ? mixing_layers(frame) : mixing_layers(frame, splats);
  if (layers == 0) return 0;
  if (!mixing_pass) {
    auto made = MixingPass::create(compute);
    if (!made) return 0;  // a driver that refuses it: the front-most particle brings its look
    mixing_pass = std::move(made.value());
  }
  run("mixing",
      [&] { mixing_pass->draw(frame, into, fluid_passes->smoothed(into), of.spheres, of.count, layers); });
  mixing_pass->bind();
  return layers;
}

bool Renderer::Parts::draw_caustics(const Targets& into) {
  const bool wanted = options.caustics && options.lit_fluid && !fast && shadow.size > 0;
  if (!wanted || !has_opaque(frame) || !any_fluid_is_clear(frame)) return false;
  if (!caustics_pass) {
    auto made = CausticsPass::create();
    if (!made) return false;  // a driver that refuses it: without
    caustics_pass = std::move(made.value());
  }
  run("caustics", [&] { caustics_pass->draw(frame, into, fluid_passes->smoothed(into)); });
  return true;
}

bool Renderer::Parts::prepare_fluid(bool chords) {
  prepare_splats(frame, options, splats);
  if (chords) {
    splats.all.clear();
    std::ranges::copy_if(splats.spheres, std::back_inserter(splats.all),
                         [](const glm::vec4& sphere) { return sphere.w == std::floor(sphere.w); });
  }
  if (fast) leave_out_hidden(frame, options, splats);
  if (splats.empty()) return false;
  if (options.surface == Surface::kOurs) {
    if (!std::exchange(centers_sorted, true)) centers.sort(frame);
    centers.move(frame, splats);
  }
  fluid_passes->upload(splats);
  return true;
}

bool Renderer::Parts::sums_chords() const {
  return options.layers && options.surface != Surface::kPaper && any_fluid_is_clear(frame);
}

bool Renderer::Parts::mirrors_bodies() const {
  return !fast && options.body_reflections && options.fresnel && has_opaque(frame);
}

void Renderer::Parts::draw_foam(const Targets& into) {
  if (!foam_pass) {
    if (auto made = FoamPass::create(far_light.defines())) foam_pass = std::move(made.value());
  }
  if (foam_pass) foam_pass->draw(frame, into, fluid_depth(into));
}

void Renderer::Parts::draw_scene() {
  const std::optional<PixelBox> part = part_to_draw();
  const auto run_in_part = [&](const char* name, auto&& pass) {
    run(name, [&] {
      if (part) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(part->low.x, part->low.y, part->size().x, part->size().y);
      }
      pass();
      glDisable(GL_SCISSOR_TEST);
    });
  };
  const bool chords = sums_chords();
  far_light.bind();
  uniforms.upload(make_frame_block(frame, options, shadow, chords));
  drew_caustics = false;
  const bool occlusion = occludes();
  run_in_part("opaque meshes", [&] {
    scene_pass->draw_opaque(frame, meshes, textures, wet_maps, targets, options.draw_background, occlusion);
  });
  // A CPU's driver draws these with its own threads while the splats are made ready in main memory, and what
  // follows until the filter's depths are there while it works.
  glFlush();
  run("prepare splats", [&] { drew_fluid = prepare_fluid(chords); });
  if (drew_fluid) {
    run("front depth", [&] { fluid_passes->splat_front(targets); });
    run("fetch front", [&] { fluid_passes->fetch_front(targets, options); });
    run("back depth", [&] { fluid_passes->splat_back(targets); });
    if (chords) run("thickness", [&] { thickness_pass->draw(frame, targets, splats.all); });
  }
  if (occlusion) {
    run("occlusion", [&] { scene_pass->start_occlusion(targets, kOcclusionReach); });
    run("resolve", [&] { scene_pass->start_resolve(targets); });
  }
  if (drew_fluid) {
    glFlush();
    run("surface filter", [&] { fluid_passes->smooth(targets, options, frame); });
  }
  const bool translucent = has_translucent(frame);
  if (drew_fluid) {
    if (translucent && !fast) {
      run("translucent behind", [&] {
        scene_pass->draw_translucent(frame, meshes, textures, targets, fluid_depth(targets), true);
      });
    }
    run("copy scene colour", [&] {
      const PixelBox box = part.value_or(PixelBox{glm::ivec2(0), targets.size});
      glCopyImageSubData(targets.color.name(), GL_TEXTURE_2D, 0, box.low.x, box.low.y, 0,
                         targets.scene_color.name(), GL_TEXTURE_2D, 0, box.low.x, box.low.y, 0, box.size().x,
                         box.size().y, 1);
    });
    drew_caustics = draw_caustics(targets);
    const LitLook look{draw_mixing(targets, fluid_passes->splats()), mirrors_bodies(), drew_caustics};
    run_in_part("composite",
                [&] { fluid_passes->start_composite(targets, options.lit_fluid ? &look : nullptr); });
  }
  if (!frame.foam.empty()) run_in_part("foam", [&] { draw_foam(targets); });
  if (translucent) {
    run_in_part("translucent", [&] {
      scene_pass->draw_translucent(frame, meshes, textures, targets, fluid_depth(targets), false);
    });
  }
  if (!frame.arrows.empty()) {
    run_in_part("arrows", [&] { arrow_pass->draw(frame, targets, fluid_depth(targets)); });
  }
  run_in_part("display",
              [&] { display_pass->start(targets, options.exposure, options.dither, options.antialias); });
  if (options.antialias) {
    run("edges", [&] { display_pass->smooth_edges(targets, part); });
  }
}

}  // namespace slosh
