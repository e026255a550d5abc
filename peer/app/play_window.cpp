#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "net/clock.h"
#include "peer/app/find_headset.h"
#include "peer/app/interrupt.h"
#include "peer/app/play_modes.h"
#include "peer/app/run_report.h"
#include "peer/app/state_folder.h"
#include "peer/app/window_controls.h"
#include "peer/app/window_film.h"
#include "peer/devices/hardware.h"
#include "peer/output/whole_file.h"
#include "peer/view/painter.h"
#include "peer/view/picture_scale.h"
#include "render/context.h"

namespace slosh {
namespace {

/// Where a picture or table that somebody wants to keep goes: with the run's files, else here. `what`:
/// "picture".
std::filesystem::path free_name(const Stage& stage, const std::string& what, const char* extension) {
  const std::string stem = stage.folder.empty() ? "slosh-" + folder_name(stage.scene.name, "scene") +
                                                      (what == "picture" ? "" : "-" + what)
                                                : what;
  for (int n = 1;; ++n) {
    std::filesystem::path file = stage.folder / (stem + "-" + std::to_string(n) + extension);
    std::error_code code;
    if (!std::filesystem::exists(file, code)) return file;
  }
}

/// Shows a run until it ends or the user wants no more of it.
class WindowRun {
 public:
  /// `headset`: null without one.
  WindowRun(const Stage& stage, LiveRun& run, Context& context, Renderer& renderer, HeadsetView* headset,
            WindowFilm& film, KeyBindings keys, Progress& progress)
      : stage_(stage),
        run_(run),
        context_(context),
        renderer_(renderer),
        headset_(headset),
        film_(film),
        progress_(progress),
        painter_(stage.scene, run.facts(kWindowSnapshotRate), renderer),
        controls_(stage.scene, run, painter_.camera(), std::move(keys), KeptViews(file_of_views(stage.scene)),
                  [&progress](const std::string& text) { progress.note(text); }) {
    controls_.filter = renderer.options().bilateral_iterations;
    painter_.show_ghost(stage.ghost);
    for (const Error& what : painter_.left_out())
      progress.note("slosh: " + what.text() + "; the run goes on without it");
  }

  /// Until somebody wears the headset and their hands are followed; they may take longer than this.
  void wait_for_headset() {
    if (!headset_) return;
    progress_.phase("waiting for the headset", "(put it on)");
    const std::int64_t until_ns = steady_now_ns() + to_nanoseconds(kWaitForHeadset);
    while (!headset_->ready() && steady_now_ns() < until_ns && interrupted_by() == 0) {
      context_.poll();
      if (context_.should_close()) return;
      if (headset_->turn([this](const HeadsetPictures& p) { painter_.draw_nothing(p); }) ==
          HeadsetView::Turn::kNotSeen) {
        sleep_until_ns(steady_now_ns() + to_nanoseconds(0.02));
      }
    }
    progress_.phase("running");
  }

  void show(Histogram& frame_time, std::uint64_t& frames) {
    SnapshotPointer snapshot;
    RunTerminal terminal(stage_, run_, progress_);
    while (true) {
      InputState input = context_.poll();
      if (worn_) {  // the window shows what an eye sees: not where a pointer would be
        input.buttons.fill(false);
        input.scroll = glm::vec2(0.0f);
      }
      if (context_.should_close() || interrupted_by() != 0) return;
      const glm::ivec2 picture = glm::max(context_.framebuffer_size(), glm::ivec2(1));
      const WindowControls::Wish wish =
          controls_.follow(input, picture, snapshot ? &snapshot->rigid : nullptr);
      if (wish == WindowControls::Wish::kEnd) return;
      if (RenderOptions render = renderer_.options(); render.bilateral_iterations != controls_.filter) {
        render.bilateral_iterations = controls_.filter;
        if (const Result<bool> set = renderer_.set_options(render); !set) controls_.say(set.error().text());
      }
      painter_.hud().paused = run_.paused();
      const OrbitCamera& camera = painter_.camera();
      run_.look_from(camera_axes(camera.eye(), camera.target()));
      if (SnapshotPointer newest = run_.newest_snapshot()) {
        snapshot = std::move(newest);
        painter_.record(*snapshot);
        controls_.record(*snapshot);
      }
      const Rates rates = terminal.turn();
      if (!run_.running()) return;

      if (headset_) {
        const HeadsetView::Turn turn =
            headset_->turn([&](const HeadsetPictures& p) { draw_eyes(p, snapshot, rates, frame_time); });
        if (turn == HeadsetView::Turn::kEnded) return;
        if (worn_ != (turn == HeadsetView::Turn::kDrawn)) context_.follow_screen(worn_);
        worn_ = turn == HeadsetView::Turn::kDrawn;
        if (worn_) {
          if (wish == WindowControls::Wish::kPicture) keep_picture();
          renderer_.present();
          context_.swap();
          frames += 1;
          tell_refused();
          continue;
        }
      }
      const glm::ivec2 size = context_.framebuffer_size();
      if (!snapshot || size.x < 16 || size.y < 16) {  // minimised
        sleep_until_ns(steady_now_ns() + to_nanoseconds(0.02));
        continue;
      }
      const glm::ivec2 drawn = drawn_size(size);
      if (drawn.x != renderer_.options().width || drawn.y != renderer_.options().height) {
        renderer_.resize(drawn.x, drawn.y);
      }
      renderer_.stretch_to(size);
      const std::int64_t begin_ns = steady_now_ns();
      painter_.draw(*snapshot, rates, [&] { controls_.draw(*snapshot, size, painter_.hud().panels()); });
      if (const std::optional<std::string> table = controls_.take_forces()) keep_forces(*table);
      if (wish == WindowControls::Wish::kPicture) keep_picture();
      if (film_.due()) film_.add(renderer_.read_back());
      const double drawing = to_seconds(steady_now_ns() - begin_ns);
      context_.swap();
      if (context_.is_software()) pixels_.took(1e3 * drawing);
      frame_time.add(to_seconds(steady_now_ns() - begin_ns));
      frames += 1;
      tell_refused();
    }
  }

 private:
  /// Once: that the particles go through main memory, and why.
  void tell_refused() {
    if (told_refused_ || renderer_.particles_refused().empty()) return;
    progress_.note("slosh: " + renderer_.particles_refused());
    told_refused_ = true;
  }

  static constexpr double kBudget = 33.0;  // ms of a picture where a CPU draws

  /// Of the 3-D picture in a window of that many pixels, which it is stretched to; the HUD has all of them. A
  /// film's pictures are never drawn smaller.
  glm::ivec2 drawn_size(const glm::ivec2& window) const {
    const double scale = film_.wanted() ? 1.0 : pixels_.scale();
    return glm::max(glm::ivec2(glm::round(scale * glm::dvec2(window))), glm::ivec2(16));
  }

  static constexpr double kWaitForHeadset = 5.0;  // s

  void draw_eyes(const HeadsetPictures& pictures, const SnapshotPointer& snapshot, const Rates& rates,
                 Histogram& frame_time) {
    if (!snapshot) return painter_.draw_nothing(pictures);
    const std::int64_t begin_ns = steady_now_ns();
    Image both;
    const bool film = film_.due();
    const std::optional<RoomInWorld> room = headset_->link()->room();
    painter_.draw(pictures, *snapshot, rates, headset_->controllers(), room ? room->scale : 1.0,
                  film ? &both : nullptr);
    frame_time.add(to_seconds(steady_now_ns() - begin_ns));
    if (film) film_.add(std::move(both));
  }

  void keep_picture() {
    const Result<std::filesystem::path> written =
        write_png(free_name(stage_, "picture", ".png"), renderer_.read_back());
    controls_.say(written ? "the picture is in " + written.value().string() : written.error().text());
  }

  void keep_forces(const std::string& table) {
    const std::filesystem::path file = free_name(stage_, "forces", ".csv");
    const Result<bool> written = write_whole(file, table);
    controls_.say(written ? "the forces are in " + file.string() : written.error().text());
  }

  const Stage& stage_;
  LiveRun& run_;
  Context& context_;
  Renderer& renderer_;
  HeadsetView* headset_;
  bool worn_ = false;  // in the last turn
  bool told_refused_ = false;
  WindowFilm& film_;
  Progress& progress_;
  Painter painter_;
  WindowControls controls_;
  PictureScale pixels_{kBudget};
};

}  // namespace

Result<bool> show_in_window(const Stage& stage, const MakeRun& make_run, const ShowOptions& options,
                            HeadsetView* headset, Progress& progress, RunSummary& summary) {
  Result<KeyBindings> keys = KeyBindings::make(options.keys);
  if (!keys) return keys.error();
  Result<std::unique_ptr<Context>> context =
      make_view_context("slosh: " + stage.scene.name, stage.width, stage.height, options, headset);
  if (!context) return context.error();
  struct GiveBack {
    HeadsetView* headset;
    ~GiveBack() {
      if (headset) headset->stop();
    }
  } const give_back{headset};  // before the context goes
  const auto tell = [&progress](const std::string& text) { progress.note("slosh: " + text); };
  if (options.stereo && !headset)
    tell("--stereo is of films without a window (--headless); this one has one eye");
  if (headset) {
    const Result<bool> started = headset->start(*context.value(), stage.scene, tell);
    if (!started && !context.value()->has_window()) return started.error();
    if (!started) tell(started.error().text() + "; it is tried again, and the window is there");
  }
  const RenderOptions render = picture_options(stage, options, progress);
  Histogram frame_time;
  WindowFilm film(stage.folder, options.frames_per_second);
  progress.phase("running", context.value()->has_window() ? "(H in the window for help)" : "(Ctrl-C ends)");

  Result<std::unique_ptr<Renderer>> renderer = Renderer::create(*context.value(), render);
  if (!renderer) return renderer.error();
  Result<std::unique_ptr<LiveRun>> made = make_run();
  if (!made) return made.error();
  LiveRun& run = *made.value();
  WindowRun window(stage, run, *context.value(), *renderer.value(), headset, film, keys.value(), progress);
  window.wait_for_headset();
  run.start();
  window.show(frame_time, summary.frames);
  run.stop();
  run.report(summary);
  summary.rendered = true;
  summary.renderer = context.value()->description() + where_particles_are_read(*renderer.value());
  summary.fast_picture = renderer.value()->quality() == Quality::kFast;
  const RenderOptions& last = renderer.value()->options();
  const glm::ivec2 shown =
      headset ? glm::ivec2(last.width, last.height) : context.value()->framebuffer_size();
  summary.width = shown.x;
  summary.height = shown.y;
  summary.frame_ms = spread_of(frame_time, 1e3);
  film.finish(summary);
  return true;
}

}  // namespace slosh
