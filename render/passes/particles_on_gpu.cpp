#include "render/passes/particles_on_gpu.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/gl/pixel_program.h"
#include "render/passes/frame_block.h"
#include "render/passes/smooth_centers.h"
#include "render/passes/splats.h"

namespace slosh {
namespace {

void bind(GLuint binding, const gl::StreamBuffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.name());
}

constexpr std::size_t kVec4 = sizeof(glm::vec4);
// As particles.glsl, smooth_centers.comp and cells_deep.comp have them.
constexpr std::size_t kCountsOfAll = 3;  // after the entries' own
constexpr std::size_t kSmoothed = 32;    // particles in a group
constexpr std::size_t kDeepInGroup = 8;  // cells

/// About so many particles are in a cell at least, of a fluid that is not spray: groups that are started by
/// it go over the rest by turns.
constexpr std::size_t kInACell = 8;

/// Of fewer particles most are near a surface. Of 33 thousand in a broken dam half are deep inside, of a
/// million four in five.
constexpr std::size_t kManyParticles = 10000;

}  // namespace

Result<ParticlesOnGpu> ParticlesOnGpu::create() {
  ParticlesOnGpu out;
  for (const Result<bool>& loaded :
       {gl::take(out.take_, gl::Program::create_compute("particles.comp")),
        gl::take(out.take_into_cells_, gl::Program::create_compute("particles.comp", {"CELLS"})),
        gl::take(out.clear_, gl::Program::create_compute("cells_clear.comp")),
        gl::take(out.begin_, gl::Program::create_compute("cells_begin.comp")),
        gl::take(out.begin_lists_, gl::Program::create_compute("cells_begin.comp", {"LISTS"})),
        gl::take(out.fill_, gl::Program::create_compute("cells_fill.comp")),
        gl::take(out.sort_, gl::Program::create_compute("cells_fill.comp", {"SORT"})),
        gl::take(out.find_seen_, gl::Program::create_compute("cells_deep.comp")),
        gl::take(out.smooth_, gl::Program::create_compute("smooth_centers.comp")),
        gl::take(out.smooth_seen_, gl::Program::create_compute("smooth_centers.comp", {"SEEN"})),
        gl::take(out.place_, gl::Program::create_compute("splats.comp")),
        gl::take(out.place_shaped_, gl::Program::create_compute("splats.comp", {"SHAPED"})),
        gl::take(out.place_seen_, gl::Program::create_compute("splats.comp", {"SHAPED", "SEEN"}))}) {
    if (!loaded) return loaded.error();
  }
  return out;
}

void ParticlesOnGpu::take(const Frame& frame, bool moves) {
  const std::size_t fluids = std::min(frame.fluids.size(), kMaxFluidLooks);
  count_ = std::min(frame.particles.size(), frame.particle_fluid.size());
  radius_ = frame.particle_radius;
  moves_ = moves && radius_ > 0.0f && std::isfinite(radius_);
  // Where fluids mix, what is two particles deep counts too.
  leaves_out_deep_ = count_ > kManyParticles && fluids == 1;
  if (fluids == 0) count_ = 0;
  steps_.clear();
  if (count_ == 0) return;
  if (moves_) steps_ = {Step::kSmooth, Step::kSort, Step::kFill, Step::kBegin};
  start_taking(frame);
  if (!given_.to_be_checked()) return;
  const bool right = taken_are(frame);
  given_.checked(right);
  if (!right) start_taking(frame);
}

void ParticlesOnGpu::start_taking(const Frame& frame) {
  particles_.reserve(count_ * kVec4);
  const gl::Program& program = moves_ ? take_into_cells_ : take_;
  if (moves_) {
    // Some fifteen particles are in a cell inside a fluid.
    entries_ = std::bit_ceil(std::max<std::size_t>(count_ / 2, 1024));
    const std::size_t fours = (entries_ + kCountsOfAll + 3) / 4;
    counts_.reserve(fours * kVec4);
    bind(3, counts_);
    gl::run_each(clear_, fours);
    ranks_.reserve(count_ * sizeof(std::uint32_t));
    begins_.reserve(entries_ * sizeof(std::uint32_t));
    owners_.reserve(entries_ * 2 * sizeof(std::uint32_t));
    if (leaves_out_deep_) {
      used_.reserve(std::min(count_, entries_) * sizeof(std::uint32_t));
      seen_.reserve(count_ * sizeof(std::uint32_t));
    }
    listed_.reserve(count_ * sizeof(std::uint32_t));
    sorted_.reserve(count_ * kVec4);
    centers_.reserve(count_ * kVec4);
    ellipsoids_.reserve(count_ * 2 * kVec4);
    program.set("entries", static_cast<int>(entries_));
    program.set("reach", SmoothCenters::reach(radius_));
    bind(4, ranks_);
    bind(10, owners_);
  }
  given_.bind(frame, count_, 0, 1);
  bind(2, particles_);
  program.set("fluids", static_cast<int>(std::min(frame.fluids.size(), kMaxFluidLooks)));
  gl::run_each(program, count_);
  given_.done();
}

/// Copied first: a buffer that is read back itself may be moved to where the GPU reads it slowly.
bool ParticlesOnGpu::taken_are(const Frame& frame) const {
  const gl::Buffer copy = gl::make_buffer();
  const auto bytes = static_cast<GLsizeiptr>(count_ * kVec4);
  glNamedBufferStorage(copy.name(), bytes, nullptr, 0);
  glCopyNamedBufferSubData(particles_.name(), copy.name(), 0, 0, bytes);
  std::vector<glm::vec4> taken(count_);
  glGetNamedBufferSubData(copy.name(), 0, bytes, taken.data());
  const std::size_t fluids = std::min(frame.fluids.size(), kMaxFluidLooks);
  for (std::size_t i = 0; i < count_; ++i) {
    const glm::vec3& at = frame.particles[i];
    const bool finite = std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z);
    const bool drawn = frame.particle_fluid[i] < fluids && finite;
    const glm::vec4 wanted =
        drawn ? glm::vec4(at, frame.particle_fluid[i]) : glm::vec4(0.0f, 0.0f, 0.0f, -1.0f);
    if (taken[i] != wanted) return false;
  }
  return true;
}

void ParticlesOnGpu::start_next() {
  if (steps_.empty()) return;
  const Step step = steps_.back();
  steps_.pop_back();
  const float reach = SmoothCenters::reach(radius_);
  bind(2, particles_);
  bind(3, counts_);
  bind(4, ranks_);
  bind(5, begins_);
  bind(6, listed_);
  bind(7, sorted_);
  bind(10, owners_);
  if (leaves_out_deep_) {
    bind(8, seen_);
    bind(9, used_);
  }
  const auto set_cells = [&](const gl::Program& program) {
    program.set("entries", static_cast<int>(entries_));
    program.set("reach", reach);
  };
  switch (step) {
    case Step::kBegin:
      return gl::start_each(leaves_out_deep_ ? begin_lists_ : begin_, entries_);
    case Step::kFill:
      set_cells(fill_);
      return gl::start_each(fill_, count_);
    case Step::kSort:
      set_cells(sort_);
      gl::start_each(sort_, count_);
      if (!leaves_out_deep_) return;
      find_seen_.set("entries", static_cast<int>(entries_));
      return gl::start_groups_by_turns(find_seen_, count_ / (kInACell * kDeepInGroup) + 1);
    case Step::kSmooth: {
      bind(0, centers_);
      bind(1, ellipsoids_);
      const gl::Program& program = leaves_out_deep_ ? smooth_seen_ : smooth_;
      program.set("entries", static_cast<int>(entries_));
      program.set("lengths", glm::vec2(reach, radius_));
      return gl::start_by_turns(program, count_, kSmoothed);
    }
  }
}

void ParticlesOnGpu::start_placing(const Frame& frame, float splat_radius, const gl::Texture& scene_depth,
                                   SplatBuffers& out) const {
  out.count = count_;
  out.shaped = moves_;
  if (count_ == 0) return;
  const bool listed = moves_ && leaves_out_deep_;
  out.seen = listed ? &counts_ : nullptr;
  out.seen_at = listed ? static_cast<int>(entries_) + 1 : -1;
  const gl::Program& program = listed ? place_seen_ : moves_ ? place_shaped_ : place_;
  out.spheres.reserve(count_ * kVec4);
  bind(0, out.spheres);
  bind(2, moves_ ? sorted_ : particles_);
  if (moves_) {
    out.shapes.reserve(count_ * sizeof(SplatShape));
    bind(1, out.shapes);
    bind(4, centers_);
    bind(5, ellipsoids_);
    gl::bind_textures({&scene_depth});
    program.set("lying", frame.wall ? glm::vec2(SmoothCenters::reach(radius_), radius_) : glm::vec2(0.0f));
  }
  if (listed) {
    bind(6, counts_);
    bind(8, seen_);
    program.set("seen_at", out.seen_at);
  }
  program.set("near_plane", frame.view.near_plane);
  program.set("reach", splat_radius);
  gl::start_each(program, count_);
}

}  // namespace slosh
