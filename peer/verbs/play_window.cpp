#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "net/clock.h"
#include "peer/output/video.h"
#include "peer/verbs/interrupt.h"
#include "peer/verbs/play_modes.h"
#include "peer/verbs/session.h"
#include "peer/view/mouse_hand.h"
#include "peer/view/painter.h"
#include "render/context.h"

namespace slosh {
namespace {

constexpr double kPictureRate = 60.0;  // snapshots a simulated second, for a smooth window

/// The film of a window, when a folder was given: what is on show, at a fixed rate of wall time.
class WindowFilm {
 public:
  WindowFilm(const std::filesystem::path& folder, const PlayOptions& options)
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

  void finish(RunSummary& summary, Progress& progress) {
    if (video_) {
      const Result<bool> finished = video_->finish();
      if (!finished) problem_ = finished.error().text();
      const Result<std::filesystem::path> written = write_png(folder_ / "final.png", image_);
      if (!written) problem_ = written.error().text();
      if (problem_.empty()) summary.files.insert(summary.files.end(), {"view.mp4", "final.png"});
    }
    if (!problem_.empty()) progress.note("slosh: the film: " + problem_);
  }

 private:
  std::filesystem::path folder_;
  const PlayOptions& options_;
  std::unique_ptr<Video> video_;
  Image image_;
  std::int64_t next_ns_ = 0;
  std::uint64_t frames_ = 0;
  std::string problem_;
};

enum class Outcome { kEnd, kAgain };

/// Shows one session until it ends or the user wants another.
class WindowRun {
 public:
  WindowRun(const Prepared& prepared, Session& session, std::vector<std::shared_ptr<MouseTarget>> targets,
            Context& context, Renderer& renderer, WindowFilm& film)
      : prepared_(prepared),
        session_(session),
        context_(context),
        renderer_(renderer),
        film_(film),
        painter_(prepared.scene, session.facts(kPictureRate), renderer),
        targets_(std::move(targets)) {
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      hands_.emplace_back(grip_start(prepared.scene, i));
      painter_.hud().mouse_hand |= targets_[i] != nullptr;
    }
  }

  Outcome show(Progress& progress, Histogram& frame_time, std::uint64_t& frames) {
    SnapshotPointer snapshot;
    while (true) {
      const InputState& input = context_.poll();
      if (context_.should_close() || interrupted_by() != 0) return Outcome::kEnd;
      if (input.pressed(Key::kEscape) || input.pressed(Key::kQ)) return Outcome::kEnd;
      if (input.pressed(Key::kR)) return Outcome::kAgain;
      handle(input);
      if (SnapshotPointer newest = session_.channel().pictures().pop_newest()) {
        snapshot = std::move(newest);
        painter_.record(*snapshot);
      }
      const Rates rates = session_.note_rates();
      progress.update(std::isfinite(prepared_.seconds) ? rates.time / prepared_.seconds : -1.0,
                      running_text(rates, prepared_.seconds));
      if (!session_.host().running()) return Outcome::kEnd;

      const glm::ivec2 size = context_.framebuffer_size();
      if (!snapshot || size.x < 16 || size.y < 16) {  // minimised
        sleep_until_ns(steady_now_ns() + to_nanoseconds(0.02));
        continue;
      }
      if (size.x != renderer_.options().width || size.y != renderer_.options().height) {
        renderer_.resize(size.x, size.y);
      }
      const std::int64_t begin_ns = steady_now_ns();
      painter_.draw(*snapshot, rates);
      film_.offer(renderer_);
      context_.swap();
      frame_time.add(to_seconds(steady_now_ns() - begin_ns));
      frames += 1;
    }
  }

 private:
  void handle(const InputState& input) {
    Hud& hud = painter_.hud();
    if (input.pressed(Key::kH)) hud.show_help = !hud.show_help;
    if (input.pressed(Key::kC)) painter_.camera().reset();
    if (input.pressed(Key::kSpace)) {
      hud.paused = !hud.paused;
      session_.host().pause(hud.paused);
    }
    const int height = renderer_.options().height;
    if (!hud.mouse_hand) {
      painter_.camera().follow(input, height);
      return;
    }
    // The mouse is a hand: only the left button turns the camera.
    if (input.held(MouseButton::kLeft)) {
      InputState camera_input = input;
      camera_input.scroll = glm::vec2(0.0f);
      painter_.camera().follow(camera_input, height);
    }
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      if (targets_[i] && hands_[i].follow(input, painter_.camera(), height)) {
        targets_[i]->back() = hands_[i].wanted();
        targets_[i]->publish();
      }
    }
  }

  const Prepared& prepared_;
  Session& session_;
  Context& context_;
  Renderer& renderer_;
  WindowFilm& film_;
  Painter painter_;
  std::vector<std::shared_ptr<MouseTarget>> targets_;
  std::vector<MouseHand> hands_;
};

}  // namespace

Result<bool> play_in_window(const Prepared& prepared, const PlayOptions& options, Progress& progress,
                            RunSummary& summary) {
  Result<std::unique_ptr<Context>> context =
      make_window_context("slosh: " + prepared.scene.name, prepared.width, prepared.height);
  if (!context) return context.error();
  RenderOptions render;
  render.width = prepared.width;
  render.height = prepared.height;
  render.bilateral_iterations = options.bilateral;
  Histogram frame_time;
  WindowFilm film(prepared.folder, options);
  progress.phase("running", "(H in the window for help)");

  Outcome outcome = Outcome::kAgain;
  while (outcome == Outcome::kAgain) {
    // A fresh renderer a run: it has no way to give meshes back.
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(*context.value(), render);
    if (!renderer) return renderer.error();
    Result<DeviceSet> devices = make_devices(prepared.scene, options.devices, true);
    if (!devices) return devices.error();
    std::vector<std::shared_ptr<MouseTarget>> targets = devices.value().mouse_targets;
    Result<std::unique_ptr<Session>> session =
        Session::create(prepared, std::move(devices.value()), kPictureRate);
    if (!session) return session.error();
    WindowRun run(prepared, *session.value(), std::move(targets), *context.value(), *renderer.value(), film);
    session.value()->start();
    outcome = run.show(progress, frame_time, summary.frames);
    session.value()->stop();
    if (outcome != Outcome::kEnd) continue;
    session.value()->report(summary);
    summary.rendered = true;
    summary.renderer = context.value()->description();
    summary.width = renderer.value()->options().width;
    summary.height = renderer.value()->options().height;
    summary.frame_ms = {1e3 * frame_time.percentile(0.5), 1e3 * frame_time.percentile(0.99),
                        1e3 * frame_time.max()};
  }
  if (!prepared.folder.empty()) summary.files = {"wrenches.csv", "poses.csv"};
  film.finish(summary, progress);
  return true;
}

}  // namespace slosh
