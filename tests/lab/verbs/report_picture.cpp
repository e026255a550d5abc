// `slosh report picture`: ways to make a surface of particles beside each other, in numbers and pictures.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <tuple>

#include "peer/app/interrupt.h"
#include "peer/app/verbs.h"
#include "peer/output/whole_file.h"
#include "peer/view/frame_builder.h"
#include "peer/view/orbit_camera.h"
#include "render/context.h"
#include "render/renderer.h"
#include "sim/math/format.h"
#include "tests/lab/picture/reference/path_tracer.h"
#include "tests/lab/picture/score/score.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/trial.h"
#include "tests/lab/verbs/report.h"
#include "tests/lab/verbs/report_picture_shapes.h"
#include "tests/lab/verbs/report_picture_stand.h"
#include "tests/lab/verbs/report_picture_water.h"

namespace slosh {
namespace {

constexpr const char* kPictureTable = "picture.md";
constexpr const char* kSheet = "picture.png";
constexpr const char* kShapes = "shapes.png";
struct Method {
  const char* name;
  Surface surface;
};
constexpr Method kMethods[] = {{"paper, section 5", Surface::kPaper},
                               {"curvature flow", Surface::kCurvatureFlow},
                               {"ours", Surface::kOurs}};

/// Paths a pixel of the reference, and its size over a picture's.
constexpr int kSamples = 96;
constexpr int kQuickSamples = 24;

struct PictureRow {
  score::SurfaceScore at5;
  score::SurfaceScore at15;
  double still_normal = 0.0;  ///< degrees
  double flicker = 0.0;       ///< of 255
  score::StirScore stir;
  double filter_ms = 0.0;
  double frame_ms = 0.0;
  std::optional<score::PictureScore> off_reference;
};

struct KnownPool {
  score::Pool pool;
  score::Exact exact;
  KnownPool(float pixels, int width, int height)
      : pool(score::make_pool(pixels, width, height)), exact(score::exact_pool(pool, width, height)) {}
};

Result<score::SurfaceScore> score_pool(Context& context, Surface surface, const KnownPool& known) {
  auto made =
      Renderer::create(context, report_options(surface, known.exact.depth.width, known.exact.depth.height));
  if (!made) return made.error();
  const Frame frame = known.pool.frame();
  made.value()->draw(frame);
  return score::score_surface(made.value()->read_buffer(Buffer::kSmoothDepth),
                              made.value()->read_buffer(Buffer::kNormal), known.exact, frame.particle_radius,
                              3.0f * frame.particle_radius);
}

/// Means over each picture with the one before and the one after.
score::StirScore score_stirred(Stand& stand, const std::vector<Snapshot>& stirred) {
  std::array<FloatImage, 3> light;
  std::array<FloatImage, 3> index;
  score::StirScore mean;
  const auto each = 1.0 / static_cast<double>(stirred.size() - 2);
  for (std::size_t i = 0; i < stirred.size(); ++i) {
    stand.draw(stirred[i]);
    std::ranges::rotate(light, light.begin() + 1);
    std::ranges::rotate(index, index.begin() + 1);
    light[2] = stand.renderer().read_buffer(Buffer::kFinalColor);
    index[2] = stand.renderer().read_buffer(Buffer::kFluidIndex);
    if (i < 2) continue;
    const score::StirScore one = score::score_stir(light, index);
    mean.change += one.change * each;
    mean.restless += one.restless * each;
    mean.pixels += one.pixels;
  }
  return mean;
}

/// The same by path tracing. Errors: built without Embree.
Result<Image> reference_picture(const Scene& scene, double spacing, const Snapshot& snapshot, int samples,
                                int threads) {
  auto tracer = reference::PathTracer::create();
  if (!tracer) return tracer.error();
  FrameBuilder builder(scene, spacing, *tracer.value());
  const OrbitCamera camera(scene.camera);
  Frame frame = builder.build(snapshot, camera.distance());
  frame.view = camera.view(static_cast<double>(kReportWidth) / kReportHeight);
  reference::Options options;
  options.width = kReportWidth;
  options.height = kReportHeight;
  options.samples = samples;
  options.threads = threads;
  const FloatImage light = tracer.value()->draw(frame, options);
  return shown_image(light);
}

/// Pictures of one height beside each other.
Image beside(const std::vector<Image>& images) {
  int width = 0, height = 0, left = 0;
  for (const Image& image : images) {
    width += image.width;
    height = image.height;
  }
  Image sheet = empty_sheet(width, height);
  for (const Image& image : images) {
    put(image, left, 0, sheet);
    left += image.width;
  }
  return sheet;
}

std::string table_of(const std::vector<PictureRow>& rows) {
  std::string text =
      "| surface | normal error at 5 px: mean, p95, edge band | at 15 px | outline off, at 5 px | still "
      "water: normal "
      "error | flicker | slow stir: restless, of all change | off the reference: in the fluid, along its "
      "edges | filter, ms | frame, ms "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const PictureRow& row = rows[i];
    text += format(
        "| %s | %.1f°, %.1f°, %.1f° | %.1f°, %.1f°, %.1f° | %.1f px | %.1f° | %.2f/255 | %.2f of %.2f/255 | "
        "%s | %.1f | %.1f "
        "|\n",
        kMethods[i].name, row.at5.normal_mean, row.at5.normal_p95, row.at5.edge_mean, row.at15.normal_mean,
        row.at15.normal_p95, row.at15.edge_mean, row.at5.silhouette, row.still_normal, row.flicker,
        row.stir.restless, row.stir.change,
        row.off_reference
            ? format("%.1f, %.1f of 255", row.off_reference->inside, row.off_reference->edges).c_str()
            : "–",
        row.filter_ms, row.frame_ms);
  }
  return text;
}

}  // namespace

int report_picture(const ReportOptions& options) {
  HeadlessOptions headless;
  headless.software_threads = options.threads > 0 ? options.threads : 1;
  auto context = make_headless_context(headless);
  if (!context) return fail(context.error());
  const Result<std::filesystem::path> folder =
      report_folder(options, "picture", kPictureTable, Draws::kNoPlots);
  if (!folder) return fail(folder.error());
  const double spacing = options.quick ? 0.012 : 0.008;
  report::Setting setting;
  setting.spacing = spacing;
  setting.stopped = [] { return interrupted_by() != 0; };

  std::vector<PictureRow> rows(std::size(kMethods));
  std::vector<Image> pictures;
  FloatImage fluid_depth;  ///< of ours
  double reference_seconds = 0.0;
  std::string no_reference;
  BucketTimes bucket;
  std::optional<Result<ShapeStudy>> shapes;
  std::size_t particles = 0;
  try {
    const Scene dam_scene = tank_scene(true).scene;
    const Scene still_scene = tank_scene(false).scene;
    report::Cost cost;
    report::Trial dam(dam_scene, setting, cost);
    std::printf("a dam breaks\n");
    dam.run(0.24);
    const Snapshot broken = dam.picture();
    particles = broken.positions.size();
    std::printf("water comes to rest\n");
    report::Trial still(still_scene, setting, cost);
    still.settle(1.0);
    std::vector<Snapshot> rest;
    for (int i = 0; i < 10; ++i) {
      still.run(1.0 / 30.0);
      rest.push_back(still.picture());
    }
    std::printf("it is stirred\n");
    const auto [stir_scene, stirred] = stirred_water(setting, spacing, 12);
    std::printf("pools are filled\n");
    const int width = options.quick ? 480 : 960;
    const int height = options.quick ? 270 : 540;
    const KnownPool fine(5.0f, width, height);
    const KnownPool coarse(15.0f, width, height);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      std::printf("%s\n", kMethods[i].name);
      for (const KnownPool* known : {&fine, &coarse}) {
        const auto scored = score_pool(*context.value(), kMethods[i].surface, *known);
        if (!scored) return fail(scored.error());
        (known == &fine ? rows[i].at5 : rows[i].at15) = scored.value();
      }
      auto stand = Stand::create(*context.value(), kMethods[i].surface, dam_scene, spacing);
      if (!stand) return fail(stand.error());
      pictures.push_back(stand.value()->draw(broken));
      if (kMethods[i].surface == Surface::kOurs)
        fluid_depth = stand.value()->renderer().read_buffer(Buffer::kFrontDepth);
      std::tie(rows[i].filter_ms, rows[i].frame_ms) = stand.value()->times(options.quick ? 3 : 20);
      auto calm = Stand::create(*context.value(), kMethods[i].surface, still_scene, spacing);
      if (!calm) return fail(calm.error());
      Image before;
      for (const Snapshot& snapshot : rest) {
        const Image now = calm.value()->draw(snapshot);
        rows[i].flicker += score::flicker(before, now) / static_cast<double>(rest.size() - 1);
        before = now;
      }
      auto stirring = Stand::create(*context.value(), kMethods[i].surface, stir_scene, spacing);
      if (!stirring) return fail(stirring.error());
      rows[i].stir = score_stirred(*stirring.value(), stirred);
      const float radius = static_cast<float>(0.62 * spacing);
      rows[i].still_normal =
          score::score_surface(calm.value()->renderer().read_buffer(Buffer::kSmoothDepth),
                               calm.value()->renderer().read_buffer(Buffer::kNormal),
                               still_surface(calm.value()->view(), spacing, kReportWidth, kReportHeight),
                               radius, 3.0f * radius)
              .normal_mean;
    }
    shapes = study_shapes(*context.value(), setting, options.quick, std::max(options.threads, 1));
    if (!*shapes) std::printf("%s\n", shapes->error().text().c_str());
    std::printf("the bucket\n");
    const auto timed = bucket_times(*context.value(), setting, options.quick ? 5 : 30);
    if (!timed) return fail(timed.error());
    bucket = timed.value();
    std::printf("the reference, by path tracing\n");
    const auto start = std::chrono::steady_clock::now();
    const auto truth = reference_picture(dam_scene, spacing, broken, options.quick ? kQuickSamples : kSamples,
                                         std::max(options.threads, 1));
    reference_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (truth) {
      for (std::size_t i = 0; i < rows.size(); ++i)
        rows[i].off_reference = score::score_picture(pictures[i], truth.value(), fluid_depth, 0.05f);
      pictures.push_back(truth.value());
    } else {
      no_reference = truth.error().text();
      std::printf("%s\n", no_reference.c_str());
    }
  } catch (const report::Refused& refused) {
    return fail(refused.error);
  } catch (const report::Stopped&) {
    return kExitFailed;
  }
  const std::string table = table_of(rows);
  const std::string about = format(
      "Normals against an analytic pool (particles of 5 and 15 pixels of radius, %s; within 8 px of a depth "
      "edge\n"
      "apart) and against still water that was simulated; flicker: mean change of a channel between "
      "pictures\n"
      "1/30 s apart of that water; slow stir: a rod goes through it at 63 mm/s; mean change of a channel of "
      "a\n"
      "pixel of fluid from one such picture to the next, and of it what is restless: how far a picture is "
      "from "
      "the\n"
      "mean of the one before and the one after; times of a broken dam of %zu particles at %dx%d, medians; "
      "off the "
      "reference: "
      "mean\ndifference of a channel of that picture from one by path tracing%s, over the fluid's pixels and "
      "over those "
      "within 8 px\nof its edges.\n\n",
      options.quick ? "480x270" : "960x540", particles, kReportWidth, kReportHeight,
      no_reference.empty()
          ? format(" (%d paths a pixel, %.0f s)", options.quick ? kQuickSamples : kSamples, reference_seconds)
                .c_str()
          : ", which is not there");
  const std::string drawn_by =
      context.value()->description() +
      format(", %d thread%s; ", headless.software_threads, headless.software_threads == 1 ? "" : "s") +
      machine_line(options) + "\n";
  const std::string of_bucket = format(
      "\nA picture of the shipped bucket (%dx%d, %g mm), let go over its table, with its read-back: %.1f ms "
      "of processor "
      "time\nwhole, %.1f with what stands still kept, as a window has it while the eye stands still "
      "(medians); by the clock, "
      "the fastest, %.1f and %.1f.\n\n",
      kReportWidth, kReportHeight, 1e3 * kBucketSpacing, bucket.whole.processor, bucket.kept.processor,
      bucket.whole.wall, bucket.kept.wall);
  const std::string of_shapes =
      shapes && *shapes
          ? format("Beside the same at %g mm, by ray: pieces are connected pixels of fluid.\n\n",
                   1e3 * shapes->value().right_spacing) +
                shape_table(shapes->value())
          : std::string();
  std::printf("\n%s\n%s%s%s", table.c_str(), of_shapes.c_str(), of_bucket.c_str(), drawn_by.c_str());
  const Result<bool> written = write_whole(
      folder.value() / kPictureTable,
      about + table + "\n" + of_shapes + of_bucket + drawn_by +
          "\nThe pictures, left to right: paper, curvature flow, ours" +
          (no_reference.empty() ? ", the reference" : "") + ".\n\n![](picture.png)\n" +
          (of_shapes.empty() ? ""
                             : "\nOutside of a vessel, left to right: as it should be, then coarser and "
                               "coarser.\n\n![](shapes.png)\n"));
  if (!written) return fail(written.error());
  const auto sheet = write_png(folder.value() / kSheet, beside(pictures));
  if (!sheet) return fail(sheet.error());
  if (of_shapes.empty()) return kExitOk;
  const auto shown = write_png(folder.value() / kShapes, shapes->value().sheet);
  return shown ? kExitOk : fail(shown.error());
}

}  // namespace slosh
