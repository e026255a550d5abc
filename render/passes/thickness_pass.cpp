#include "render/passes/thickness_pass.h"

#include <algorithm>

namespace slosh {
namespace {

/// Radius of a summed sphere over a particle's: wide enough that the sum of a few layers is even.
constexpr float kChordWide = 1.5f;
/// Optical depth of four particle radii above which a channel shows nothing of what is behind.
constexpr float kOpaque = 5.0f;

}  // namespace

bool any_fluid_is_clear(const Frame& frame) {
  return std::ranges::any_of(frame.fluids, [&](const FluidLook& fluid) {
    const glm::vec3& e = fluid.extinction;
    return std::min({e.x, e.y, e.z}) * 4.0f * frame.particle_radius < kOpaque;
  });
}

Result<ThicknessPass> ThicknessPass::create(bool compute) {
  ThicknessPass pass;
  if (compute) {
    for (const Result<bool>& loaded :
         {gl::take(pass.rows_, gl::RowProgram::create("chord.comp", true)),
          gl::take(pass.sum_, gl::PixelProgram::create("chord_sum.frag", true, false, {"EACH 4"}))}) {
      if (!loaded) return loaded.error();
    }
  } else if (auto made = gl::take(pass.program_, gl::Program::create("chord.vert", "chord.frag")); !made) {
    return made.error();
  }
  pass.array_ = gl::make_vertex_array();
  glEnableVertexArrayAttrib(pass.array_.name(), 0);
  glVertexArrayAttribFormat(pass.array_.name(), 0, 4, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(pass.array_.name(), 0, 0);
  return pass;
}

void ThicknessPass::set_up(const gl::Program& program, const Frame& frame, const Targets& targets) {
  program.set("sphere", glm::vec2(kChordWide * frame.particle_radius, frame.particle_radius));
  // Of the picture's pixels in one of its own, along a side.
  program.set("pixels", targets.chord_size == targets.half_size ? 2 : 4);
  gl::bind_textures({&targets.scene_depth});
}

void ThicknessPass::start_sums(const Frame& frame, const Targets& targets, const ParticlesOnGpu& particles,
                               float reach, Sums& sums) const {
  const gl::Program& program = rows_.of(particles.count());
  program.set("near_plane", frame.view.near_plane);
  program.set("reach", reach);
  set_up(program, frame, targets);
  const glm::ivec2 size = targets.chord_size;
  if (sums.size != size)
    sums.texels.zero(sizeof(std::uint32_t) * static_cast<std::size_t>(size.x) *
                     static_cast<std::size_t>(size.y));
  sums.size = size;
  program.set("size", size);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, particles.by_cell().name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, sums.texels.name());
  rows_.start(particles.count());
}

void ThicknessPass::start_chords(const Targets& targets, const Sums& sums) const {
  sum_.program().set("size", sums.size);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, sums.texels.name());
  sum_.start({targets.chord, targets.chord_target, sums.size, GL_R16F});
}

void ThicknessPass::draw(const Frame& frame, const Targets& targets, std::span<const glm::vec4> spheres) {
  buffer_.upload(spheres);
  set_up(program_, frame, targets);
  const glm::vec4 none(0.0f);
  glClearNamedFramebufferfv(targets.chord_target.name(), GL_COLOR, 0, &none.x);
  glVertexArrayVertexBuffer(array_.name(), 0, buffer_.name(), 0, sizeof(glm::vec4));
  glBindFramebuffer(GL_FRAMEBUFFER, targets.chord_target.name());
  glViewport(0, 0, targets.chord_size.x, targets.chord_size.y);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  program_.use();
  glBindVertexArray(array_.name());
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(spheres.size()));
  glBlendFunc(GL_ONE, GL_ZERO);
  glDisable(GL_BLEND);
  glDisable(GL_PROGRAM_POINT_SIZE);
}

}  // namespace slosh
