#include "render/passes/surface_filter.h"

#include <utility>

#include "render/passes/narrow_range_on_cpu.h"

namespace slosh {
namespace {

/// Runs `program` from where the surface is into the other smooth texture; returns which that is.
int turn(const gl::PixelProgram& program, int from, const Targets& targets, const gl::TileDraw& tiles) {
  const std::size_t into = from == 0 ? 1 : 0;
  const gl::Texture& source = from < 0 ? targets.front : targets.smooth[static_cast<std::size_t>(from)];
  gl::bind_textures({&source});
  program.run({targets.smooth[into], targets.smooth_target[into], targets.size, GL_R32F}, &tiles);
  return static_cast<int>(into);
}

/// Section 5.1 and Fig 5.
class PaperFilter : public SurfaceFilter {
 public:
  explicit PaperFilter(gl::PixelProgram program) : program_(std::move(program)) {}
  int run(const Targets& targets, const RenderOptions& options, const Frame&,
          const gl::TileDraw& tiles) override {
    int at = -1;
    for (int i = 0; i < options.bilateral_iterations; ++i) at = turn(program_, at, targets, tiles);
    return at;
  }
  bool writes_tiles() const override { return !program_.on_compute(); }

 private:
  gl::PixelProgram program_;
};

/// van der Laan, Green & Sainz 2009.
class CurvatureFlow : public SurfaceFilter {
 public:
  explicit CurvatureFlow(gl::PixelProgram program) : program_(std::move(program)) {}
  int run(const Targets& targets, const RenderOptions&, const Frame&, const gl::TileDraw& tiles) override {
    program_.program().set("time_step", kTimeStep);
    int at = -1;
    for (int i = 0; i < kSteps; ++i) at = turn(program_, at, targets, tiles);
    return at;
  }
  bool writes_tiles() const override { return !program_.on_compute(); }

 private:
  static constexpr int kSteps = 60;         // as timed there
  static constexpr float kTimeStep = 0.8f;  // of the longest stable one
  gl::PixelProgram program_;
};

// Of Truong & Yuksel's, in splat radii; the best of those tried on analytic pools (render/score).
constexpr float kReach = 3.8f;
constexpr float kRange = 5.0f;

/// Truong & Yuksel 2018: along both axes, then 5 × 5 pixels.
class NarrowRange : public SurfaceFilter {
 public:
  NarrowRange(gl::PixelProgram along, gl::PixelProgram clean)
      : along_(std::move(along)), clean_(std::move(clean)) {}
  int run(const Targets& targets, const RenderOptions& options, const Frame& frame,
          const gl::TileDraw& tiles) override {
    const float radius = options.splat_scale * frame.particle_radius;
    const glm::vec3 kernel(kReach * radius, kRange * radius, kTaps);
    along_.program().set("kernel", kernel);
    clean_.program().set("kernel", kernel);
    along_.program().set("axis", glm::ivec2(1, 0));
    int at = turn(along_, -1, targets, tiles);
    along_.program().set("axis", glm::ivec2(0, 1));
    at = turn(along_, at, targets, tiles);
    return turn(clean_, at, targets, tiles);
  }
  bool writes_tiles() const override { return !along_.on_compute(); }

 private:
  static constexpr float kTaps = 40.0f;
  gl::PixelProgram along_;
  gl::PixelProgram clean_;
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
          const gl::TileDraw&) override {
    const float radius = options.splat_scale * frame.particle_radius;
    const float pixels = 0.5f * frame.view.projection[1][1] * static_cast<float>(targets.size.y);
    const std::span<const float> surface =
        filter_.run(front_, targets.size, {kReach * radius, kRange * radius, kTaps, pixels});
    glTextureSubImage2D(targets.smooth[0].name(), 0, 0, 0, targets.size.x, targets.size.y, GL_RED, GL_FLOAT,
                        surface.data());
    return 0;
  }
  bool writes_tiles() const override { return false; }

 private:
  static constexpr int kTaps = 6;
  NarrowRangeOnCpu filter_;
  std::vector<float> front_;
};

}  // namespace

Result<std::unique_ptr<SurfaceFilter>> make_surface_filter(Surface surface, bool on_cpu, bool compute) {
  using Made = Result<std::unique_ptr<SurfaceFilter>>;
  if (surface == Surface::kOurs && on_cpu) return Made(std::make_unique<NarrowRangeBesideGl>());
  const char* file = surface == Surface::kPaper           ? "smooth.frag"
                     : surface == Surface::kCurvatureFlow ? "curvature_flow.frag"
                                                          : "narrow_range.frag";
  auto program = gl::PixelProgram::create(file, compute, true);
  if (!program) return program.error();
  if (surface == Surface::kPaper) return Made(std::make_unique<PaperFilter>(std::move(program.value())));
  if (surface == Surface::kCurvatureFlow)
    return Made(std::make_unique<CurvatureFlow>(std::move(program.value())));
  auto clean = gl::PixelProgram::create(file, compute, true, {"CLEAN"});
  if (!clean) return clean.error();
  return Made(std::make_unique<NarrowRange>(std::move(program.value()), std::move(clean.value())));
}

}  // namespace slosh
