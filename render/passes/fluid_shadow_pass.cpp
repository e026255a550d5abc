#include "render/passes/fluid_shadow_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace slosh {
namespace {

/// Texture unit of shaders/shadow.glsl.
constexpr GLuint kFluidShadowUnit = 9;

/// Of a disc that falls off evenly, over a ball that is as dark at half its height (fluid_shadow.glsl).
constexpr float kSoft = 1.25f;

}  // namespace

Result<FluidShadowPass> FluidShadowPass::create(bool fast, bool compute) {
  FluidShadowPass pass;
  pass.compute_ = compute;
  if (compute) {
    for (const Result<bool>& loaded :
         {gl::take(pass.rows_, gl::RowProgram::create("fluid_shadow.comp", false)),
          gl::take(pass.sum_, gl::PixelProgram::create("fluid_shadow_sum.frag", true))}) {
      if (!loaded) return loaded.error();
    }
  } else if (auto made =
                 gl::take(pass.program_, gl::Program::create("fluid_shadow.vert", "fluid_shadow.frag"));
             !made) {
    return made.error();
  }
  pass.size_ = fast ? 256 : 512;
  pass.most_ = fast ? 8000 : 300000;
  pass.map_ = gl::make_texture(glm::ivec2(pass.size_), GL_RGBA16F, GL_LINEAR);
  pass.target_ = gl::make_framebuffer({&pass.map_});
  pass.array_ = gl::make_vertex_array();
  glEnableVertexArrayAttrib(pass.array_.name(), 0);
  glVertexArrayAttribFormat(pass.array_.name(), 0, 4, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(pass.array_.name(), 0, 0);
  return pass;
}

void FluidShadowPass::clear() const {
  const glm::vec4 none(0.0f);
  glClearNamedFramebufferfv(target_.name(), GL_COLOR, 0, &none.x);
}

bool FluidShadowPass::begin(const Frame& frame, const RenderOptions& options, const ShadowView& shadow,
                            std::size_t count) {
  glBindTextureUnit(kFluidShadowUnit, map_.name());
  const bool empty = !options.fluid_shadow || shadow.size == 0 || count == 0 || frame.fluids.empty();
  // What sums up writes every texel.
  if (empty || !compute_) clear();
  return !empty;
}

void FluidShadowPass::set_up(const gl::Program& program, const Frame& frame, const RenderOptions& options,
                             const ShadowView& shadow, std::size_t step) {
  std::array<glm::vec3, kMaxFluidLooks> extinction{};
  for (std::size_t i = 0; i < std::min(frame.fluids.size(), kMaxFluidLooks); ++i)
    extinction[i] = frame.fluids[i].extinction;
  // Where all dim alike, one sum a texel does for the three channels.
  const float most = std::max({extinction[0].x, extinction[0].y, extinction[0].z});
  const bool alike = compute_ && frame.fluids.size() == 1 && most > 0.0f;
  program.set("sums_a_texel", alike ? 1 : 3);
  alike_ = alike ? extinction[0] / most : glm::vec3(0.0f);
  if (alike) extinction[0] = glm::vec3(most);
  glProgramUniform3fv(program.name(), glGetUniformLocation(program.name(), "extinction"),
                      static_cast<GLsizei>(extinction.size()), &extinction[0].x);
  // Fewer splats are drawn wider, so that they still close up, and their sum stays the same. Little wider
  // than that takes: the shadow is to end where the fluid does.
  const float radius =
      kSoft * frame.particle_radius * std::max(options.splat_scale, std::cbrt(static_cast<float>(step)));
  const glm::mat4& clip = shadow.clip_from_world;
  const float clip_per_metre = glm::length(glm::vec3(clip[0][0], clip[1][0], clip[2][0]));
  const float texels = std::clamp(radius * clip_per_metre * static_cast<float>(size_), 1.0f, 64.0f);
  const float drawn_radius = texels / (clip_per_metre * static_cast<float>(size_));
  const float volume = frame.particle_radius;
  program.set("clip_from_world", clip);
  program.set("point_size", texels);
  program.set("weight", static_cast<float>(step));
  // A disc of another size keeps the sphere's volume.
  program.set("chord", 2.0f * volume * volume * volume / (drawn_radius * drawn_radius));
}

bool FluidShadowPass::start_sums(const Frame& frame, const RenderOptions& options, const ShadowView& shadow,
                                 const ParticlesOnGpu& particles) {
  if (!begin(frame, options, shadow, particles.count())) return false;
  const std::size_t step = (particles.count() + most_ - 1) / most_;
  const std::size_t drawn = (particles.count() + step - 1) / step;
  const gl::Program& program = rows_.of(drawn);
  set_up(program, frame, options, shadow, step);
  program.set("stride", static_cast<int>(step));
  const auto side = static_cast<std::size_t>(size_);
  if (!std::exchange(sums_ready_, true)) sums_.zero(4 * sizeof(std::uint32_t) * side * side);
  program.set("size", size_);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, particles.particles().name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, sums_.name());
  rows_.start(drawn);
  return true;
}

void FluidShadowPass::start_map() {
  sum_.program().set("size", size_);
  sum_.program().set("alike", alike_);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, sums_.name());
  sum_.start({map_, target_, glm::ivec2(size_), GL_RGBA16F});
}

void FluidShadowPass::draw(const Frame& frame, const RenderOptions& options, const ShadowView& shadow) {
  const std::size_t count = std::min(frame.particles.size(), frame.particle_fluid.size());
  if (!begin(frame, options, shadow, count)) return;
  const std::size_t fluids = std::min(frame.fluids.size(), kMaxFluidLooks);
  const std::size_t step = (count + most_ - 1) / most_;
  particles_.clear();
  for (std::size_t i = 0; i < count; i += step) {
    const glm::vec3& at = frame.particles[i];
    const float sum = at.x + at.y + at.z;
    if (frame.particle_fluid[i] < fluids && std::isfinite(sum)) {
      particles_.emplace_back(at, static_cast<float>(frame.particle_fluid[i]));
    }
  }
  if (particles_.empty()) {
    clear();
    return;
  }
  buffer_.upload(std::span<const glm::vec4>(particles_));
  set_up(program_, frame, options, shadow, step);
  glVertexArrayVertexBuffer(array_.name(), 0, buffer_.name(), 0, sizeof(glm::vec4));
  glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
  glViewport(0, 0, size_, size_);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glEnable(GL_DEPTH_CLAMP);  // what flies out of the light's box still shades
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBlendEquationSeparate(GL_FUNC_ADD, GL_MAX);
  program_.use();
  glBindVertexArray(array_.name());
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(particles_.size()));
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_PROGRAM_POINT_SIZE);
}

}  // namespace slosh
