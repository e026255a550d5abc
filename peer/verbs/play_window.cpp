#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "net/clock.h"
#include "peer/haptics/devices/hardware.h"
#include "peer/output/video.h"
#include "peer/verbs/interrupt.h"
#include "peer/verbs/local_run.h"
#include "peer/verbs/play_modes.h"
#include "peer/verbs/window_controls.h"
#include "peer/view/painter.h"
#include "render/context.h"

namespace slosh {
namespace {

/// The film of a window, when a folder was given: what is on show, at a fixed rate of wall time.
class WindowFilm {
 public:
  WindowFilm(const std::filesystem::path& folder, const ShowOptions& options)
      : folder_(folder), options_(options) {}

  /// Call after each draw.
  void offer(Renderer& renderer) {
    if (folder_.empty()) return;
    const std::int64_t now_ns = steady_now_ns();
    if (frames_ > 0 && now_ns < next_ns_) return;
    if (frames_ == 0) next_ns_ = now_ns;
    next_ns_ += to_nanoseconds(1.0 / options_.frames_per_second);
    image_ = renderer.read_back();
    if (!video_) {
      Result<std::unique_ptr<Video>> started =
          Video::start(folder_ / "view.mp4", image_.width, image_.height, options_.frames_per_second);
      if (!started) {
        problem_ = started.error().text();
        folder_.clear();
        return;
      }
      video_ = std::move(started.value());
    }
    // The window was resized: the film keeps its size and waits until the window has it again.
    (void)video_->add(image_);
    frames_ += 1;
  }

  void finish(RunSummary& summary) {
    if (video_) {
      const Result<bool> finished = video_->finish();
      if (!finished) problem_ = finished.error().text();
      const Result<std::filesystem::path> written = write_png(folder_ / "final.png", image_);
      if (!written) problem_ = written.error().text();
      if (problem_.empty()) summary.files.insert(summary.files.end(), {"view.mp4", "final.png"});
    }
    if (!problem_.empty()) summary.problems.push_back("the film: " + problem_);
  }

 private:
  std::filesystem::path folder_;
  const ShowOptions& options_;
  std::unique_ptr<Video> video_;
  Image image_;
  std::int64_t next_ns_ = 0;
  std::uint64_t frames_ = 0;
  std::string problem_;
};

enum class Outcome { kEnd, kAgain };

/// Where a picture that somebody wants to keep goes: with the run's files, else here.
std::filesystem::path free_picture_name(const Stage& stage) {
  const std::string stem =
      stage.folder.empty() ? "slosh-" + folder_name(stage.scene.name, "scene") : "picture";
  for (int n = 1;; ++n) {
    std::filesystem::path file = stage.folder / (stem + "-" + std::to_string(n) + ".png");
    std::error_code code;
    if (!std::filesystem::exists(file, code)) return file;
  }
}

/// Shows one run until it ends or the user wants another.
class WindowRun {
 public:
  WindowRun(const Stage& stage, LiveRun& run, Context& context, Renderer& renderer, WindowFilm& film,
            Progress& progress)
      : stage_(stage),
        run_(run),
        context_(context),
        renderer_(renderer),
        film_(film),
        progress_(progress),
        painter_(stage.scene, run.facts(kWindowSnapshotRate), renderer),
        controls_(stage.scene, run, painter_.camera(),
                  [&progress](const std::string& text) { progress.note(text); }) {}

  Outcome show(Histogram& frame_time, std::uint64_t& frames) {
    SnapshotPointer snapshot;
    std::optional<LineInput> typed;
    TroubleTeller trouble;
    if (run_.hears()) typed.emplace(progress_.terminal());
    while (true) {
      const InputState& input = context_.poll();
      if (context_.should_close() || interrupted_by() != 0) return Outcome::kEnd;
      const glm::ivec2 picture(renderer_.options().width, renderer_.options().height);
      const WindowControls::Wish wish =
          controls_.follow(input, picture, snapshot ? &snapshot->rigid : nullptr);
      if (wish == WindowControls::Wish::kEnd) return Outcome::kEnd;
      if (wish == WindowControls::Wish::kAgain) return Outcome::kAgain;
      painter_.hud().paused = run_.paused();
      const OrbitCamera& camera = painter_.camera();
      run_.look_from(camera_axes(camera.eye(), camera.target()));
      hear_lines(run_, typed ? &*typed : nullptr, progress_);
      trouble.tell(run_, progress_);
      if (SnapshotPointer newest = run_.newest_snapshot()) {
        snapshot = std::move(newest);
        painter_.record(*snapshot);
      }
      const Rates rates = run_.note_rates();
      progress_.update(std::isfinite(stage_.seconds) ? (rates.time - rates.start) / stage_.seconds : -1.0,
                       running_text(rates, stage_.seconds));
      if (!run_.running()) return Outcome::kEnd;

      const glm::ivec2 size = context_.framebuffer_size();
      if (!snapshot || size.x < 16 || size.y < 16) {  // minimised
        sleep_until_ns(steady_now_ns() + to_nanoseconds(0.02));
        continue;
      }
      if (size.x != renderer_.options().width || size.y != renderer_.options().height) {
        renderer_.resize(size.x, size.y);
      }
      const std::int64_t begin_ns = steady_now_ns();
      painter_.draw(*snapshot, rates, [this] { controls_.draw(); });
      if (wish == WindowControls::Wish::kPicture) keep_picture();
      film_.offer(renderer_);
      context_.swap();
      frame_time.add(to_seconds(steady_now_ns() - begin_ns));
      frames += 1;
    }
  }

 private:
  void keep_picture() {
    const Result<std::filesystem::path> written = write_png(free_picture_name(stage_), renderer_.read_back());
    controls_.say(written ? "the picture is in " + written.value().string() : written.error().text());
  }

  const Stage& stage_;
  LiveRun& run_;
  Context& context_;
  Renderer& renderer_;
  WindowFilm& film_;
  Progress& progress_;
  Painter painter_;
  WindowControls controls_;
};

}  // namespace

Result<bool> show_in_window(const Stage& stage, const MakeRun& make_run, const ShowOptions& options,
                            Progress& progress, RunSummary& summary) {
  Result<std::unique_ptr<Context>> context =
      make_window_context("slosh: " + stage.scene.name, stage.width, stage.height);
  if (!context) return context.error();
  const RenderOptions render = picture_options(stage, options);
  Histogram frame_time;
  WindowFilm film(stage.folder, options);
  progress.phase("running", "(H in the window for help)");

  Outcome outcome = Outcome::kAgain;
  while (outcome == Outcome::kAgain) {
    // A fresh renderer a run: it has no way to give meshes back.
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(*context.value(), render);
    if (!renderer) return renderer.error();
    Result<std::unique_ptr<LiveRun>> made = make_run();
    if (!made) return made.error();
    LiveRun& run = *made.value();
    WindowRun window(stage, run, *context.value(), *renderer.value(), film, progress);
    run.start();
    outcome = window.show(frame_time, summary.frames);
    progress.typed("");
    run.stop();
    if (outcome != Outcome::kEnd) continue;
    run.report(summary);
    summary.rendered = true;
    summary.renderer = context.value()->description();
    summary.width = renderer.value()->options().width;
    summary.height = renderer.value()->options().height;
    summary.frame_ms = {1e3 * frame_time.percentile(0.5), 1e3 * frame_time.percentile(0.99),
                        1e3 * frame_time.max()};
  }
  film.finish(summary);
  return true;
}

Result<bool> play_in_window(const Prepared& prepared, const PlayOptions& options, Progress& progress,
                            RunSummary& summary) {
  bool told = false;
  const MakeRun make_run = [&]() -> Result<std::unique_ptr<LiveRun>> {
    Result<DeviceSet> devices = make_devices(prepared.scene, options.devices, true);
    if (!devices) return devices.error();
    Result<std::unique_ptr<LocalRun>> run = LocalRun::create(prepared, std::move(devices.value()),
                                                             kWindowSnapshotRate, told ? nullptr : &progress);
    if (!run) return run.error();
    told = true;
    catch_interrupts();
    return std::unique_ptr<LiveRun>(std::move(run.value()));
  };
  return show_in_window(prepared, make_run, options, progress, summary);
}

}  // namespace slosh
