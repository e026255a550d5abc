#include "tests/lab/verbs/report_picture_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "peer/view/frame_builder.h"
#include "peer/view/orbit_camera.h"
#include "render/renderer.h"
#include "sim/math/format.h"
#include "tests/lab/picture/reference/path_tracer.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/verbs/report_picture_stand.h"

namespace slosh {
namespace {

constexpr glm::ivec2 kSize(320, 240);  // pixels, of a picture
constexpr glm::vec3 kStone(0.22f, 0.18f, 0.15f);

Pose at_height(double y) {
  Pose pose;
  pose.position.y = y;
  return pose;
}

report::SceneBuilder begun(double viscosity, const glm::dvec3& eye, const glm::dvec3& target) {
  report::SceneBuilder b;
  b.add_fluid(1000.0, viscosity);
  b.set_domain({-0.4, -0.2, -0.4}, {0.5, 0.6, 0.4});
  b.scene.camera.eye = eye;
  b.scene.camera.target = target;
  return b;
}

/// A vessel with a hole in its floor, `up` m above the origin.
void add_funnel(report::SceneBuilder& b, double radius, double fill, double hole, double up) {
  b.add_fixed("vessel", report::glass_of(radius, fill + 0.03, 0.012, hole), at_height(up));
  b.add_volume(report::filling_of(radius, fill), 0, at_height(up));
}

report::SceneBuilder stream() {
  report::SceneBuilder b = begun(0.002, {0.25, 0.22, 0.45}, {0.0, 0.17, 0.0});
  add_funnel(b, 0.06, 0.11, 0.018, 0.30);
  return b;
}

report::SceneBuilder sheet() {
  report::SceneBuilder b = begun(0.002, {0.50, 0.38, 0.34}, {0.06, 0.22, 0.0});
  b.add_fixed("floor", make::box({-0.14, 0.28, -0.08}, {0.04, 0.30, 0.08}));
  b.add_fixed("back", make::box({-0.14, 0.30, -0.08}, {-0.12, 0.42, 0.08}));
  for (const double side : {-0.08, 0.06})
    b.add_fixed(side < 0.0 ? "left" : "right", make::box({-0.12, 0.30, side}, {0.04, 0.42, side + 0.02}));
  b.add_volume(make::box({-0.12, 0.30, -0.06}, {-0.02, 0.38, 0.06}));
  return b;
}

report::SceneBuilder string_of_batter() {
  report::SceneBuilder b = begun(5.0, {0.16, 0.16, 0.32}, {0.0, 0.09, 0.0});
  add_funnel(b, 0.04, 0.08, 0.016, 0.18);
  b.add_fixed("plate", make::box({-0.1, -0.02, -0.1}, {0.1, 0.0, 0.1}));
  b.scene.fluids[0].color = {0.93f, 0.83f, 0.60f};
  b.scene.fluids[0].extinction = {500.0f, 600.0f, 900.0f};
  b.scene.fluids[0].scattering = 1.0f;
  return b;
}

report::SceneBuilder puddle() {
  report::SceneBuilder b = begun(0.5, {0.0, 0.34, 0.36}, {0.0, 0.0, 0.0});
  b.add_fixed("plate", make::box({-0.2, -0.02, -0.16}, {0.2, 0.0, 0.16}));
  b.add_volume(report::filling_of(0.045, 0.045));
  return b;
}

report::SceneBuilder film() {
  report::SceneBuilder b = begun(0.1, {0.0, 0.28, 0.20}, {0.0, 0.0, 0.0});
  b.add_fixed("dish", report::tank_at_floor({0.16, 0.025, 0.12}, 0.012));
  b.add_volume(make::box({-0.03, 0.0, -0.03}, {0.03, 0.022, 0.03}));
  return b;
}

struct ShapeCase {
  const char* name;
  report::SceneBuilder (*scene)();
  double seconds;
};
constexpr ShapeCase kCases[] = {{"stream", stream, 0.30},
                                {"sheet", sheet, 0.26},
                                {"string of batter", string_of_batter, 0.70},
                                {"puddle", puddle, 0.50},
                                {"film below a particle", film, 1.00}};

/// Drops of a particle each, which by ray are balls of its volume: so far apart that the mesh of one is not
/// drawn to another.
Snapshot drops() {
  Snapshot snapshot;
  for (int i = 0; i < 12; ++i)
    snapshot.positions.emplace_back(0.07f * (static_cast<float>(i % 4) - 1.5f),
                                    0.07f * (static_cast<float>(i / 4) - 1.0f), 0.0f);
  snapshot.fluid_index.assign(snapshot.positions.size(), 0);
  return snapshot;
}

Snapshot simulated(const Scene& scene, double seconds, report::Setting setting, double spacing) {
  setting.spacing = spacing;
  report::Cost cost;
  report::Trial trial(scene, setting, cost);
  trial.run(seconds);
  return trial.picture();
}

/// What is to be seen of particles, and the picture by path tracing.
struct ByRay {
  score::Exact seen;
  FloatImage light;
};
/// `samples` 0: no picture.
Result<ByRay> by_ray(const Scene& scene, double spacing, const Snapshot& snapshot, int samples, int threads) {
  auto tracer = reference::PathTracer::create();
  if (!tracer) return tracer.error();
  FrameBuilder builder(scene, spacing, *tracer.value());
  const OrbitCamera camera(scene.camera);
  Frame frame = builder.build(snapshot, camera.distance());
  frame.view = camera.view(static_cast<double>(kSize.x) / kSize.y);
  reference::Options options;
  options.width = kSize.x;
  options.height = kSize.y;
  options.samples = samples;
  options.threads = threads;
  options.cell = 0.5f;
  ByRay found{tracer.value()->first_seen(frame, options), {}};
  if (samples > 0) found.light = tracer.value()->draw(frame, options);
  return found;
}

/// The drawn one's buffers as score_shape() takes them.
score::Exact drawn_shape(Renderer& renderer) {
  score::Exact drawn{renderer.read_buffer(Buffer::kSmoothDepth), renderer.read_buffer(Buffer::kNormal)};
  for (std::size_t i = 0; i < drawn.depth.values.size(); ++i) {
    const float* n = &drawn.normal.values[3 * i];
    if (n[0] * n[0] + n[1] * n[1] + n[2] * n[2] < 0.5f) drawn.depth.values[i] = kNoFluidDepth;
  }
  return drawn;
}

}  // namespace

Result<ShapeStudy> study_shapes(Context& context, report::Setting setting, bool quick, int threads) {
  const std::vector<double> spacings = quick ? std::vector{0.012} : std::vector{0.006, 0.009, 0.012};
  ShapeStudy study;
  study.right_spacing = quick ? 0.004 : 0.0025;
  const int cases = static_cast<int>(std::size(kCases)) + 1;
  study.sheet = empty_sheet(kSize.x * (1 + static_cast<int>(spacings.size())), kSize.y * cases);
  for (int row = 0; row < cases; ++row) {
    const bool falling = row + 1 == cases;
    const char* name = falling ? "drops" : kCases[row].name;
    std::printf("%s\n", name);
    std::fflush(stdout);
    report::SceneBuilder builder =
        falling ? begun(0.002, {0.0, 0.0, 0.40}, {0.0, 0.0, 0.0}) : kCases[row].scene();
    for (Body& body : builder.scene.bodies) body.material.base_color = kStone;
    const Scene& scene = builder.scene;
    const auto snapshot_at = [&](double spacing) {
      return falling ? drops() : simulated(scene, kCases[row].seconds, setting, spacing);
    };
    // One for all spacings, but of drops, which are as large as the particles.
    std::optional<ByRay> right;
    for (std::size_t column = 0; column < spacings.size(); ++column) {
      const double spacing = spacings[column];
      if (!right || falling) {
        const double fine = falling ? spacing : study.right_spacing;
        auto made = by_ray(scene, fine, snapshot_at(fine), quick ? 8 : 32, threads);
        if (!made) return made.error();
        right = std::move(made.value());
        const auto shown = shown_image(right->light);
        if (!shown) return shown.error();
        put(shown.value(), 0, kSize.y * row, study.sheet);
      }
      auto stand = Stand::create(context, Surface::kOurs, scene, spacing, false, kSize);
      if (!stand) return stand.error();
      const Snapshot snapshot = snapshot_at(spacing);
      put(stand.value()->draw(snapshot), kSize.x * (static_cast<int>(column) + 1), kSize.y * row,
          study.sheet);
      const auto same = by_ray(scene, spacing, snapshot, 0, threads);
      if (!same) return same.error();
      study.rows.push_back({name, spacing,
                            score::score_shape(drawn_shape(stand.value()->renderer()), right->seen),
                            score::score_shape(same.value().seen, right->seen).overlap});
    }
  }
  return study;
}

std::string shape_table(const ShapeStudy& study) {
  std::string text =
      "| outside of a vessel | spacing, mm | silhouettes' overlap | of the same particles by ray | pieces, "
      "for | area over the right one | "
      "normal error |\n|---|---|---|---|---|---|---|\n";
  for (const ShapeRow& row : study.rows)
    text += format("| %s | %g | %.2f | %.2f | %d, %d | %.2f | %.0f° |\n", row.name.c_str(), 1e3 * row.spacing,
                   row.score.overlap, row.by_ray, row.score.pieces, row.score.right_pieces, row.score.area,
                   row.score.normal_mean);
  return text;
}

}  // namespace slosh
