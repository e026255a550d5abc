#include "render/passes/fluid_passes.h"

#include <algorithm>
#include <utility>

namespace slosh {
namespace {

void clear_to(const gl::Framebuffer& target, float depth) {
  const glm::vec4 value(depth);
  glClearNamedFramebufferfv(target.name(), GL_COLOR, 0, &value.x);
}

void draw_into(const gl::Framebuffer& target, glm::ivec2 size) {
  glBindFramebuffer(GL_FRAMEBUFFER, target.name());
  glViewport(0, 0, size.x, size.y);
}

}  // namespace

Result<FluidPasses> FluidPasses::create(bool fast, const std::vector<std::string>& far_light) {
  FluidPasses passes;
  passes.fast_ = fast;
  std::vector<std::string> looks = far_light;
  if (fast) looks.emplace_back("FAST");
  const auto load = [](gl::Program& into, const char* vertex, const char* fragment,
                       std::vector<std::string> defines = {}) -> Result<bool> {
    auto program = gl::Program::create(vertex, fragment, std::move(defines));
    if (!program) return program.error();
    into = std::move(program.value());
    return true;
  };
  for (const Result<bool>& loaded :
       {load(passes.front_program_, "splat.vert", "splat.frag", {"FRONT"}),
        load(passes.shaped_program_, "splat.vert", "splat.frag", {"FRONT", "SHAPED"}),
        load(passes.back_program_, "splat.vert", "splat.frag"),
        load(passes.composite_program_, "tiles.vert", "composite.frag", far_light),
        load(passes.look_program_, "tiles.vert", "fluid_look.frag", looks),
        load(passes.thickness_program_, "tiles.vert", "thickness.frag"),
        load(passes.normal_program_, "tiles.vert", "normal.frag")}) {
    if (!loaded) return loaded.error();
  }
  passes.no_vertices_ = gl::make_vertex_array();
  passes.tile_vertices_ = gl::make_vertex_array();
  glEnableVertexArrayAttrib(passes.tile_vertices_.name(), 0);
  glVertexArrayAttribFormat(passes.tile_vertices_.name(), 0, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(passes.tile_vertices_.name(), 0, 0);
  return passes;
}

void FluidPasses::upload(const Splats& splats) {
  sphere_buffer_.upload(std::span<const glm::vec4>(splats.spheres));
  shaped_ = splats.shapes.size() == splats.spheres.size();
  if (shaped_) shape_buffer_.upload(std::span<const SplatShape>(splats.shapes));
  tile_buffer_.upload(std::span<const glm::vec2>(splats.tiles));
  glVertexArrayVertexBuffer(tile_vertices_.name(), 0, tile_buffer_.name(), 0, sizeof(glm::vec2));
  front_count_ = static_cast<GLsizei>(splats.spheres.size());
  back_buffer_.upload(std::span<const glm::vec4>(splats.back));
  back_count_ = static_cast<GLsizei>(splats.back.size());
  tile_corners_ = static_cast<GLsizei>(splats.tiles.size());
}

void FluidPasses::splat_front(const Targets& targets) {
  clear_to(targets.front_target, kNoFluidDepth);
  draw_into(targets.front_target, targets.size);
  glEnable(GL_BLEND);
  glBlendEquation(GL_MIN);
  (shaped_ ? shaped_program_ : front_program_).use();
  if (shaped_) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, shape_buffer_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, sphere_buffer_.name());
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3 * front_count_);
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
}

void FluidPasses::splat_back(const Targets& targets) {
  clear_to(targets.back_target, 0.0f);
  draw_into(targets.back_target, targets.back_size);
  glEnable(GL_BLEND);
  glBlendEquation(GL_MAX);
  back_program_.use();
  const bool own = back_count_ > 0;
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, own ? back_buffer_.name() : sphere_buffer_.name());
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3 * (own ? back_count_ : front_count_));
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
}

void FluidPasses::fetch_front(const Targets& targets, const RenderOptions& options) {
  if (options.bilateral_iterations > 0) filter_->fetch(targets);
}

Result<bool> FluidPasses::choose(Surface surface) {
  if (filter_ && surface == surface_) return true;
  auto filter = make_surface_filter(surface, fast_);
  if (!filter) return filter.error();
  filter_ = std::move(filter.value());
  surface_ = surface;
  return true;
}

void FluidPasses::smooth(const Targets& targets, const RenderOptions& options, const Frame& frame) {
  if (filter_->on_gpu()) {
    for (const gl::Framebuffer& target : targets.smooth_target) clear_to(target, kNoFluidDepth);
  }
  smoothed_ = options.bilateral_iterations == 0
                  ? -1
                  : filter_->run(targets, options, frame, {&tile_vertices_, tile_corners_});
}

void FluidPasses::composite(const Targets& targets, bool lit) {
  gl::bind_textures({&targets.front, &smoothed(targets), &targets.back, &targets.scene_depth,
                     &targets.scene_color, &targets.chord});
  draw_into(targets.color_target, targets.size);
  (lit ? look_program_ : composite_program_).use();
  draw_tiles();
}

void FluidPasses::thickness(const Targets& targets, const gl::Framebuffer& target) {
  draw_data(thickness_program_, targets, target);
}

void FluidPasses::normals(const Targets& targets, const gl::Framebuffer& target) {
  draw_data(normal_program_, targets, target);
}

void FluidPasses::draw_data(const gl::Program& program, const Targets& targets,
                            const gl::Framebuffer& target) {
  gl::bind_textures({&targets.front, &smoothed(targets), &targets.back, &targets.scene_depth,
                     &targets.scene_color, &targets.chord});
  clear_to(target, 0.0f);
  draw_into(target, targets.size);
  program.use();
  draw_tiles();
}

const gl::Texture& FluidPasses::smoothed(const Targets& targets) const {
  return smoothed_ < 0 ? targets.front : targets.smooth[static_cast<std::size_t>(smoothed_)];
}

void FluidPasses::draw_tiles() {
  TileDraw{&tile_vertices_, tile_corners_}();
}

}  // namespace slosh
