// Pictures by compute shaders, the particles on the GPU: all views of a moment together, in stages. What
// stands in one stage waits for nothing else of it, so a GPU runs it side by side: one view's last groups
// beside the next one's first, meshes beside the smoothing of particles.
#include <algorithm>
#include <cstddef>

#include "render/renderer_parts.h"

namespace slosh {

void Renderer::Parts::choose(const Picture& picture) {
  frame.view = picture.view;
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, picture.block.name());
}

bool Renderer::Parts::blends_or_focuses() const {
  return (options.soft_mixing && options.lit_fluid && mixing_layers(frame) > 0) || options.caustics;
}

void Renderer::Parts::draw_stages(std::span<Picture> drawn) {
  const bool chords = sums_chords();
  far_light.bind();
  for (Picture& picture : drawn) {
    frame.view = picture.view;
    const FrameBlock block = make_frame_block(frame, options, shadow, chords);
    picture.block.upload(std::span(&block, 1));
  }
  drew_fluid = particles->count() > 0;
  drew_caustics = false;
  const bool tiled = scene_pass->takes_tiles(frame, meshes, textures);
  draw_stages_before_fluid(drawn, tiled);
  if (drew_fluid || occludes()) draw_stages_of_fluid(drawn, chords);
  if (drew_fluid) draw_stages_of_look(drawn, tiled);
  draw_stages_after(drawn, tiled);
  choose(drawn.front());
}

void Renderer::Parts::draw_stages_before_fluid(std::span<Picture> drawn, bool tiled) {
  run("lists, cells", [&] {
    if (tiled) each(drawn, [&](Picture& p) { scene_pass->upload_looks(frame, meshes, p.meshes); });
    each(drawn, [&](Picture& p) {
      if (tiled) scene_pass->start_lists(frame, meshes, p.meshes);
      if (drew_fluid) fluid_passes->start_clear(p.targets);
    });
    // All but the last of what makes particles ready, which goes beside the meshes.
    do {
      if (particles->steps_left() > 1) particles->start_next();
      gl::finish_compute();
    } while (particles->steps_left() > 1);
  });
  // Meshes first: where many small triangles are in one place a few groups take long, and the particles fill
  // the rest of the chip meanwhile.
  run("opaque meshes, smooth centres", [&] {
    const bool background = options.draw_background;
    each(drawn, [&](Picture& p) {
      if (tiled) return scene_pass->start_opaque(frame, p.meshes, p.targets, background, occludes());
      scene_pass->draw_opaque(frame, meshes, textures, wet_maps, p.targets, background, occludes());
    });
    particles->start_next();
    gl::finish_compute();
  });
  run(occludes() ? "occlusion, prepare splats" : "prepare splats", [&] {
    const float reach = splat_reach(frame.particle_radius, options);
    each(drawn, [&](Picture& p) {
      if (drew_fluid) particles->start_placing(frame, reach, p.targets.scene_depth, p.splats);
      if (occludes()) scene_pass->start_occlusion(p.targets, kOcclusionReach);
    });
    gl::finish_compute();
  });
}

void Renderer::Parts::draw_stages_of_fluid(std::span<Picture> drawn, bool chords) {
  const float reach = splat_reach(frame.particle_radius, options);
  run(occludes() ? "splats, resolve" : "splats", [&] {
    each(drawn, [&](Picture& p) {
      if (drew_fluid) fluid_passes->start_splats(p.targets, p.splats);
      if (drew_fluid && chords) thickness_pass->start_sums(frame, p.targets, *particles, reach, p.chord_sums);
      if (occludes()) scene_pass->start_resolve(p.targets);
    });
    gl::finish_compute();
  });
  if (!drew_fluid) return;
  run("surface filter, thickness", [&] {
    const int turns = fluid_passes->begin_filter(options);
    for (int i = 0; i < std::max(turns, 1); ++i) {
      each(drawn, [&](Picture& p) {
        if (i < turns) fluid_passes->start_turn(i, p.targets, options, frame);
        if (i == 0 && chords) thickness_pass->start_chords(p.targets, p.chord_sums);
      });
      gl::finish_compute();
    }
  });
}

void Renderer::Parts::draw_stages_of_look(std::span<Picture> drawn, bool tiled) {
  const bool panes = has_translucent(frame) && !fast;
  run(panes ? "translucent behind" : "copy scene colour", [&] {
    each(drawn, [&](Picture& p) {
      const gl::Texture* fluid = fluid_depth(p.targets);
      if (panes && tiled)
        return scene_pass->start_translucent(frame, p.meshes, p.targets, fluid, GlassPart::kBehind);
      if (panes) scene_pass->draw_translucent(frame, meshes, textures, p.targets, fluid, true);
      gl::bind_textures({&p.targets.color});
      copy_program.start({p.targets.scene_color, p.targets.scene_color_target, p.targets.size, GL_RGBA16F});
    });
    gl::finish_compute();
  });
  // What these two write there is one of, not one for each view.
  if (blends_or_focuses()) {
    each(drawn, [&](Picture& p) {
      drew_caustics = draw_caustics(p.targets);
      const LitLook look{draw_mixing(p.targets, p.splats), mirrors_bodies(), drew_caustics};
      run("composite", [&] {
        fluid_passes->start_composite(p.targets, options.lit_fluid ? &look : nullptr);
        gl::finish_compute();
      });
    });
    return;
  }
  run("composite", [&] {
    const LitLook look{0, mirrors_bodies(), false};
    each(drawn,
         [&](Picture& p) { fluid_passes->start_composite(p.targets, options.lit_fluid ? &look : nullptr); });
    gl::finish_compute();
  });
}

void Renderer::Parts::draw_stages_after(std::span<Picture> drawn, bool tiled) {
  if (!frame.foam.empty()) run("foam", [&] { each(drawn, [&](Picture& p) { draw_foam(p.targets); }); });
  if (has_translucent(frame)) {
    run("translucent", [&] {
      each(drawn, [&](Picture& p) {
        const gl::Texture* fluid = fluid_depth(p.targets);
        if (tiled)
          return scene_pass->start_translucent(frame, p.meshes, p.targets, fluid, GlassPart::kBefore);
        scene_pass->draw_translucent(frame, meshes, textures, p.targets, fluid, false);
      });
      gl::finish_compute();
    });
  }
  if (!frame.arrows.empty()) {
    run("arrows", [&] {
      each(drawn, [&](Picture& p) { arrow_pass->draw(frame, p.targets, fluid_depth(p.targets)); });
    });
  }
  run("display", [&] {
    each(drawn, [&](Picture& p) {
      display_pass->start(p.targets, options.exposure, options.dither, options.antialias);
    });
    gl::finish_compute();
  });
  if (options.antialias) {
    run("edges", [&] {
      each(drawn, [&](Picture& p) { display_pass->start_edges(p.targets); });
      gl::finish_compute();
    });
  }
}

}  // namespace slosh
