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

Result<FluidPasses> FluidPasses::create(bool fast, bool compute, const std::vector<std::string>& far_light) {
  FluidPasses passes;
  passes.fast_ = fast;
  passes.compute_ = compute;
  std::vector<std::string> looks = far_light;
  if (fast) looks.emplace_back("FAST");
  passes.look_defines_ = looks;
  const auto splats = [&](const std::vector<std::string>& defines) {
    return SplatProgram::create(compute, defines);
  };
  for (const Result<bool>& loaded :
       {gl::take(passes.front_program_, splats({"FRONT"})),
        gl::take(passes.shaped_program_, splats({"FRONT", "SHAPED"})),
        gl::take(passes.back_program_, splats({})),
        gl::take(passes.composite_program_,
                 gl::PixelProgram::create("composite.frag", compute, true, far_light)),
        gl::take(passes.look_program_, gl::PixelProgram::create("fluid_look.frag", compute, true, looks)),
        gl::take(passes.thickness_program_, gl::Program::create("tiles.vert", "thickness.frag")),
        gl::take(passes.normal_program_, gl::Program::create("tiles.vert", "normal.frag"))}) {
    if (!loaded) return loaded.error();
  }
  if (compute) {
    auto filling = gl::PixelProgram::create("fill.frag", true, false, {"EACH 4"});
    if (!filling) return filling.error();
    passes.fill_program_ = std::move(filling.value());
  }
  passes.no_vertices_ = gl::make_vertex_array();
  passes.tile_vertices_ = gl::make_vertex_array();
  glEnableVertexArrayAttrib(passes.tile_vertices_.name(), 0);
  glVertexArrayAttribFormat(passes.tile_vertices_.name(), 0, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(passes.tile_vertices_.name(), 0, 0);
  return passes;
}

Result<FluidPasses::SplatProgram> FluidPasses::SplatProgram::create(bool compute,
                                                                    const std::vector<std::string>& defines) {
  SplatProgram out;
  const auto made = compute
                        ? gl::take(out.rows, gl::RowProgram::create("splat.comp", true, defines))
                        : gl::take(out.triangles, gl::Program::create("splat.vert", "splat.frag", defines));
  if (!made) return made.error();
  return out;
}

void FluidPasses::upload(const Splats& splats) {
  splats_.count = splats.spheres.size();
  splats_.spheres.upload(std::span<const glm::vec4>(splats.spheres));
  splats_.shaped = splats.shapes.size() == splats.spheres.size();
  if (splats_.shaped) splats_.shapes.upload(std::span<const SplatShape>(splats.shapes));
  back_buffer_.upload(std::span<const glm::vec4>(splats.back));
  back_count_ = splats.back.size();
  upload_tiles(splats.tiles);
}

void FluidPasses::upload_tiles(std::span<const glm::vec2> corners) {
  tile_buffer_.upload(corners);
  glVertexArrayVertexBuffer(tile_vertices_.name(), 0, tile_buffer_.name(), 0, sizeof(glm::vec2));
  tile_corners_ = static_cast<GLsizei>(corners.size());
}

void FluidPasses::use_whole_picture() {
  constexpr glm::vec2 kPicture[] = {{-1.0f, -1.0f}, {3.0f, -1.0f}, {-1.0f, 3.0f}};
  if (tile_corners_ != static_cast<GLsizei>(std::size(kPicture))) upload_tiles(kPicture);
}

void FluidPasses::splat(const gl::Program& program, const gl::Framebuffer& target, glm::ivec2 size,
                        GLenum blending, float cleared, const gl::StreamBuffer& buffer, std::size_t count) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.name());
  clear_to(target, cleared);
  draw_into(target, size);
  glEnable(GL_BLEND);
  glBlendEquation(blending);
  program.use();
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * count));
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
}

void FluidPasses::start_clear(const Targets& targets) const {
  fill_program_.program().set("fill_with", glm::vec4(kNoFluidDepth));
  fill_program_.start({targets.front, targets.front_target, targets.size, GL_R32F});
  fill_program_.program().set("fill_with", glm::vec4(0.0f));
  fill_program_.start({targets.back, targets.back_target, targets.back_size, GL_R32F});
}

void FluidPasses::start_splats(const Targets& targets, const SplatBuffers& splats) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, splats.spheres.name());
  if (splats.shaped) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, splats.shapes.name());
  if (splats.seen) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 6, splats.seen->name());
  const auto start = [&](const gl::RowProgram& rows, const gl::Texture& into) {
    glBindImageTexture(0, into.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
    rows.of(splats.count).set("seen_at", splats.seen_at);
    rows.start(splats.count);
  };
  start((splats.shaped ? shaped_program_ : front_program_).rows, targets.front);
  start(back_program_.rows, targets.back);
}

int FluidPasses::begin_filter(const RenderOptions& options) {
  // Nobody here knows where the splats are: what is drawn as fragments later goes over the whole picture.
  use_whole_picture();
  smoothed_ = -1;
  return options.bilateral_iterations == 0 ? 0 : filter_->turns(options);
}

void FluidPasses::start_turn(int i, const Targets& targets, const RenderOptions& options,
                             const Frame& frame) {
  filter_->start_turn(i, targets, options, frame, tiles());
  smoothed_ = i % 2;
}

void FluidPasses::splat_front(const Targets& targets) {
  if (splats_.shaped) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, splats_.shapes.name());
  splat((splats_.shaped ? shaped_program_ : front_program_).triangles, targets.front_target, targets.size,
        GL_MIN, kNoFluidDepth, splats_.spheres, splats_.count);
}

void FluidPasses::splat_back(const Targets& targets) {
  const bool own = back_count_ > 0;
  splat(back_program_.triangles, targets.back_target, targets.back_size, GL_MAX, 0.0f,
        own ? back_buffer_ : splats_.spheres, own ? back_count_ : splats_.count);
}

void FluidPasses::fetch_front(const Targets& targets, const RenderOptions& options) {
  if (options.bilateral_iterations > 0) filter_->fetch(targets);
}

Result<bool> FluidPasses::choose(Surface surface) {
  if (filter_ && surface == surface_) return true;
  auto filter = make_surface_filter(surface, fast_, compute_);
  if (!filter) return filter.error();
  filter_ = std::move(filter.value());
  surface_ = surface;
  return true;
}

void FluidPasses::smooth(const Targets& targets, const RenderOptions& options, const Frame& frame) {
  if (filter_->writes_tiles()) {
    for (const gl::Framebuffer& target : targets.smooth_target) clear_to(target, kNoFluidDepth);
  }
  smoothed_ = options.bilateral_iterations == 0 ? -1 : filter_->run(targets, options, frame, tiles());
}

const gl::PixelProgram& FluidPasses::program_of(const LitLook& look, const Targets& targets) {
  if (look == LitLook{}) return look_program_;
  const auto [at, anew] = more_look_programs_.try_emplace(look);
  if (anew) {
    std::vector<std::string> defines = look_defines_;
    if (look.mixed > 0) defines.push_back("MIXED " + std::to_string(look.mixed));
    if (look.bodies) defines.emplace_back("BODIES");
    if (look.caustics) defines.emplace_back("CAUSTICS");
    auto made = gl::PixelProgram::create("fluid_look.frag", compute_, true, std::move(defines));
    if (made) at->second = std::move(made.value());
  }
  const gl::Program& program = at->second.program();
  if (!program) return look_program_;  // a driver that refuses it: without
  if (look.mixed > 0) program.set("share_pixels", targets.chord_size == targets.half_size ? 2 : 4);
  return at->second;
}

void FluidPasses::start_composite(const Targets& targets, const LitLook* look) {
  gl::bind_textures({&targets.front, &smoothed(targets), &targets.back, &targets.scene_depth,
                     &targets.scene_color, &targets.chord});
  const gl::TileDraw where = tiles();
  (look ? program_of(*look, targets) : composite_program_)
      .start({targets.color, targets.color_target, targets.size, GL_RGBA16F}, &where);
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
  tiles()();
}

const gl::Texture& FluidPasses::smoothed(const Targets& targets) const {
  return smoothed_ < 0 ? targets.front : targets.smooth[static_cast<std::size_t>(smoothed_)];
}

}  // namespace slosh
