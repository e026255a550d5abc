#include "render/gl/pixel_program.h"

#include <algorithm>
#include <string>

namespace slosh::gl {
namespace {

// As pixel_main.glsl and splat_rows.glsl have them.
constexpr glm::ivec2 kPixelGroup(16, 8);
constexpr std::size_t kInRows = 128;  // invocations in a group of rows
constexpr int kLongRow = 32;
constexpr int kShortRow = 8;
constexpr std::size_t kMany = 100000;  // splats
constexpr std::size_t kPartsOfRows = 64;
constexpr std::size_t kEachInGroup = 64;
constexpr std::size_t kByTurns = 16384;    // groups
constexpr std::size_t kMaxGroups = 32768;  // on an axis; at least 65535 are allowed

}  // namespace

void TileDraw::operator()() const {
  glBindVertexArray(vertices->name());
  glDrawArrays(GL_TRIANGLES, 0, corners);
}

Result<PixelProgram> PixelProgram::create(const char* file, bool compute, bool tiled,
                                          std::vector<std::string> defines, const std::string& prelude) {
  glm::ivec2 group = kPixelGroup;
  for (const std::string& define : defines) {
    if (define.starts_with("EACH ")) group.y *= std::stoi(define.substr(5));
  }
  auto made = compute ? Program::create_compute(file, std::move(defines), prelude)
                      : Program::create_with(tiled ? "tiles.vert" : "fullscreen.vert", file,
                                             std::move(defines), prelude);
  if (!made) return made.error();
  PixelProgram out;
  out.program_ = std::move(made.value());
  out.no_vertices_ = make_vertex_array();
  out.group_ = group;
  out.compute_ = compute;
  return out;
}

void PixelProgram::start(const PixelTarget& target, const TileDraw* tiles) const {
  program_.use();
  if (compute_) {
    glBindImageTexture(0, target.texture.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, target.format);
    const glm::ivec2 groups = (target.size + group_ - 1) / group_;
    glDispatchCompute(static_cast<GLuint>(groups.x), static_cast<GLuint>(groups.y), 1);
    return;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
  glViewport(0, 0, target.size.x, target.size.y);
  TileDraw whole{&no_vertices_, 3};
  (tiles ? *tiles : whole)();
}

void finish_compute() {
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                  GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT);
}

namespace {

/// `invocations` or rows of them, for `count`.
void start_groups(const Program& program, std::size_t count, std::size_t invocations, std::size_t in_group,
                  bool by_turns = false) {
  if (count == 0) return;
  std::size_t groups = (invocations + in_group - 1) / in_group;
  if (by_turns) groups = std::min(groups, kByTurns);
  const std::size_t across = std::min(groups, kMaxGroups);
  program.use();
  program.set("count", static_cast<int>(count));
  glDispatchCompute(static_cast<GLuint>(across), static_cast<GLuint>((groups + across - 1) / across), 1);
}

}  // namespace

void start_each(const Program& program, std::size_t count, std::size_t share) {
  start_groups(program, count, count * share, kEachInGroup);
}
void run_each(const Program& program, std::size_t count, std::size_t share) {
  start_each(program, count, share);
  finish_compute();
}

void start_by_turns(const Program& program, std::size_t count, std::size_t in_group) {
  start_groups(program, count, count, in_group, true);
}

void start_groups_by_turns(const Program& program, std::size_t groups) {
  program.use();
  glDispatchCompute(static_cast<GLuint>(std::clamp<std::size_t>(groups, 1, kByTurns)), 1, 1);
}

Result<RowProgram> RowProgram::create(const char* file, bool small, const std::vector<std::string>& defines) {
  RowProgram out;
  const auto with_lanes = [&](int lanes) {
    std::vector<std::string> all = defines;
    all.push_back("LANES " + std::to_string(lanes));
    return Program::create_compute(file, std::move(all));
  };
  if (auto made = take(out.few_, with_lanes(kLongRow)); !made) return made.error();
  if (!small) return out;
  if (auto made = take(out.many_, with_lanes(kShortRow)); !made) return made.error();
  return out;
}

bool RowProgram::short_rows(std::size_t count) const {
  return many_ && count >= kMany;
}

const Program& RowProgram::of(std::size_t count) const {
  return short_rows(count) ? many_ : few_;
}

void RowProgram::start(std::size_t count) const {
  const std::size_t rows = (count + kPartsOfRows - 1) / kPartsOfRows * kPartsOfRows;
  start_groups(of(count), count, rows, kInRows / (short_rows(count) ? kShortRow : kLongRow), true);
}

}  // namespace slosh::gl
