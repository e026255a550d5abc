#include "render/passes/surface_filter.h"

#include <utility>

#include "render/passes/narrow_range_on_cpu.h"

namespace slosh {
namespace {

/// Draws `program` from where the surface is into the other smooth texture; returns which that is.
int turn(const gl::Program& program, int from, const Targets& targets, const TileDraw& tiles) {
  const int into = from == 0 ? 1 : 0;
  const gl::Texture& source = from < 0 ? targets.front : targets.smooth[static_cast<std::size_t>(from)];
  gl::bind_textures({&source});
  glBindFramebuffer(GL_FRAMEBUFFER, targets.smooth_target[static_cast<std::size_t>(into)].name());
  glViewport(0, 0, targets.size.x, targets.size.y);
  program.use();
  tiles();
  return into;
}

/// Section 5.1 and Fig 5.
class PaperFilter : public SurfaceFilter {
 public:
  static Result<std::unique_ptr<SurfaceFilter>> create() {
    auto program = gl::Program::create("tiles.vert", "smooth.frag");
    if (!program) return program.error();
    auto filter = std::make_unique<PaperFilter>();
    filter->program_ = std::move(program.value());
    return std::unique_ptr<SurfaceFilter>(std::move(filter));
  }
  int run(const Targets& targets, const RenderOptions& options, const Frame&,
          const TileDraw& tiles) override {
    int at = -1;
    for (int i = 0; i < options.bilateral_iterations; ++i) at = turn(program_, at, targets, tiles);
    return at;
  }

 private:
  gl::Program program_;
};

/// van der Laan, Green & Sainz 2009.
class CurvatureFlow : public SurfaceFilter {
 public:
  static Result<std::unique_ptr<SurfaceFilter>> create() {
    auto program = gl::Program::create("tiles.vert", "curvature_flow.frag");
    if (!program) return program.error();
    auto filter = std::make_unique<CurvatureFlow>();
    filter->program_ = std::move(program.value());
    return std::unique_ptr<SurfaceFilter>(std::move(filter));
  }
  int run(const Targets& targets, const RenderOptions&, const Frame&, const TileDraw& tiles) override {
    program_.set("time_step", kTimeStep);
    int at = -1;
    for (int i = 0; i < kSteps; ++i) at = turn(program_, at, targets, tiles);
    return at;
  }

 private:
  static constexpr int kSteps = 60;         // as timed there
  static constexpr float kTimeStep = 0.8f;  // of the longest stable one
  gl::Program program_;
};

// Of Truong & Yuksel's, in splat radii; the best of those tried on analytic pools (render/score).
constexpr float kReach = 3.2f;
constexpr float kRange = 5.0f;

/// Truong & Yuksel 2018: along both axes, then 5 × 5 pixels.
class NarrowRange : public SurfaceFilter {
 public:
  static Result<std::unique_ptr<SurfaceFilter>> create() {
    auto along = gl::Program::create("tiles.vert", "narrow_range.frag");
    if (!along) return along.error();
    auto clean = gl::Program::create("tiles.vert", "narrow_range.frag", {"CLEAN"});
    if (!clean) return clean.error();
    auto filter = std::make_unique<NarrowRange>();
    filter->along_ = std::move(along.value());
    filter->clean_ = std::move(clean.value());
    return std::unique_ptr<SurfaceFilter>(std::move(filter));
  }
  int run(const Targets& targets, const RenderOptions& options, const Frame& frame,
          const TileDraw& tiles) override {
    const float radius = options.splat_scale * frame.particle_radius;
    const glm::vec3 kernel(kReach * radius, kRange * radius, kTaps);
    along_.set("kernel", kernel);
    clean_.set("kernel", kernel);
    along_.set("axis", glm::ivec2(1, 0));
    int at = turn(along_, -1, targets, tiles);
    along_.set("axis", glm::ivec2(0, 1));
    at = turn(along_, at, targets, tiles);
    return turn(clean_, at, targets, tiles);
  }

 private:
  static constexpr float kTaps = 40.0f;
  gl::Program along_;
  gl::Program clean_;
};

/// The same in main memory, with fewer taps.
class NarrowRangeBesideGl : public SurfaceFilter {
 public:
  void fetch(const Targets& targets) override {
    front_.resize(static_cast<std::size_t>(targets.size.x) * static_cast<std::size_t>(targets.size.y));
    glGetTextureImage(targets.front.name(), 0, GL_RED, GL_FLOAT,
                      static_cast<GLsizei>(front_.size() * sizeof(float)), front_.data());
  }
  int run(const Targets& targets, const RenderOptions& options, const Frame& frame,
          const TileDraw&) override {
    const float radius = options.splat_scale * frame.particle_radius;
    const float pixels = 0.5f * frame.view.projection[1][1] * static_cast<float>(targets.size.y);
    const std::span<const float> surface =
        filter_.run(front_, targets.size, {kReach * radius, kRange * radius, kTaps, pixels});
    glTextureSubImage2D(targets.smooth[0].name(), 0, 0, 0, targets.size.x, targets.size.y, GL_RED, GL_FLOAT,
                        surface.data());
    return 0;
  }
  bool on_gpu() const override { return false; }

 private:
  static constexpr int kTaps = 6;
  NarrowRangeOnCpu filter_;
  std::vector<float> front_;
};

}  // namespace

void TileDraw::operator()() const {
  glBindVertexArray(vertices->name());
  glDrawArrays(GL_TRIANGLES, 0, corners);
}

Result<std::unique_ptr<SurfaceFilter>> make_surface_filter(Surface surface, bool on_cpu) {
  switch (surface) {
    case Surface::kPaper:
      return PaperFilter::create();
    case Surface::kCurvatureFlow:
      return CurvatureFlow::create();
    case Surface::kOurs:
      break;
  }
  if (on_cpu) return std::unique_ptr<SurfaceFilter>(std::make_unique<NarrowRangeBesideGl>());
  return NarrowRange::create();
}

}  // namespace slosh
