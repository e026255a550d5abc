#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <thread>

#include "peer/app/interrupt.h"
#include "peer/app/play_modes.h"
#include "peer/app/run_report.h"
#include "peer/view/headless_view.h"
#include "render/color/display_transform.h"
#include "render/environment.h"
#include "render/hud_scale.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr std::chrono::milliseconds kTurn{50};

void fill_view(RunSummary& summary, const HeadlessView& view, const ViewOptions& options,
               std::uint64_t dropped) {
  const ViewReport& report = view.report();
  summary.rendered = true;
  summary.renderer = report.renderer;
  summary.fast_picture = report.fast;
  summary.width = (options.stereo ? 2 : 1) * options.render.width;
  summary.height = options.render.height;
  summary.frames = report.frames;
  summary.frames_dropped = dropped;
  summary.frame_ms = spread_of(report.frame_time, 1e3);
  if (report.frames > 0) {
    if (report.problem.empty()) summary.files.insert(summary.files.end(), {"view.mp4", "final.png"});
  }
  if (!report.problem.empty()) summary.problems.push_back("the film: " + report.problem);
}

/// "3.20 s of 10.00 s, real time × 0.98, devices 1000 Hz".
std::string running_text(const Rates& rates, double seconds) {
  std::string text = format("%.2f s", rates.time - rates.start);
  if (seconds < 1e9) text += format(" of %.2f s", seconds);
  if (rates.real_time > 0.0) text += format(", real time × %.2f", rates.real_time);
  if (rates.step_ms > 0.0) text += format(", step %.2f ms", rates.step_ms);
  if (rates.device_rate > 0.0) text += format(", devices %.0f Hz", rates.device_rate);
  return rates.connection.empty() ? text : text + ", " + rates.connection;
}

ColorConfig chosen_colors(const ShowOptions& options, Progress& progress) {
  ColorConfig asked{options.ocio, options.display, options.view};
  if (const char* usual = std::getenv("OCIO"); asked.file.empty() && usual) asked.file = usual;
  if (asked.file == "none") asked.file.clear();
  if (asked.file.empty()) {
    if (!asked.display.empty() || !asked.view.empty())
      progress.note(
          "slosh: --display and --view name those of a colour configuration, and there is none: give "
          "--ocio FILE; the built-in transform is used");
    return {};
  }
  const Result<ColorConfig> found = find_display_view(asked);
  if (found) return found.value();
  progress.note("slosh: " + found.error().text() + "; the built-in transform is used");
  return {};
}

std::shared_ptr<const Environment> chosen_environment(const ShowOptions& options, Progress& progress) {
  if (options.environment.empty()) return nullptr;
  if (options.environment == "studio") return make_studio_environment();
  const auto found = read_environment(options.environment);
  if (found) return found.value();
  progress.note("slosh: " + found.error().text() + "; the plain room is used");
  return nullptr;
}

}  // namespace

RunTerminal::RunTerminal(const Stage& stage, LiveRun& run, Progress& progress)
    : stage_(stage), run_(run), progress_(progress) {
  if (run.hears()) input_.emplace(progress.terminal());
}

void RunTerminal::wait(std::chrono::milliseconds patience) const {
  if (input_) return input_->wait(patience);
  std::this_thread::sleep_for(patience);
}

Rates RunTerminal::turn() {
  if (input_) {
    for (const std::string& line : input_->read())
      progress_.answer(input_->edits() ? line : std::string(), run_.hear(line));
    progress_.typed(input_->typed());
  }
  if (const std::string trouble = run_.trouble(); trouble != trouble_) {
    trouble_ = trouble;
    progress_.note("slosh: " + (trouble.empty() ? "what was out of order is in use again"
                                                : trouble + "; the run goes on"));
  }
  const Rates rates = run_.note_rates();
  progress_.update(std::isfinite(stage_.seconds) ? (rates.time - rates.start) / stage_.seconds : -1.0,
                   running_text(rates, stage_.seconds));
  return rates;
}

RenderOptions picture_options(const Stage& stage, const ShowOptions& options, Progress& progress) {
  RenderOptions render;
  if (options.surface == "paper") render = section_five(render);
  if (options.surface == "flow") render.surface = Surface::kCurvatureFlow;
  if (options.quality == "fast") render.quality = Quality::kFast;
  if (options.quality == "full") render.quality = Quality::kFull;
  if (options.caustics && (options.quality == "fast" || options.surface == "paper")) {
    progress.note("slosh: --caustics: there are none with --" +
                  std::string(options.quality == "fast" ? "quality fast" : "surface paper") +
                  "; the picture is drawn without them");
  } else if (options.caustics) {
    render.caustics = true;
    render.quality = Quality::kFull;
  }
  set_hud_scale(static_cast<float>(options.font_scale));
  render.width = stage.width;
  render.height = stage.height;
  render.bilateral_iterations = options.bilateral;
  render.color = chosen_colors(options, progress);
  render.environment = chosen_environment(options, progress);
  return render;
}

Result<bool> show_headless(const Stage& stage, LiveRun& run, const ShowOptions& options, Progress& progress,
                           RunSummary& summary) {
  std::unique_ptr<HeadlessView> view;
  ViewOptions view_options;
  if (options.render) {
    progress.phase("preparing the picture");
    view_options.render = picture_options(stage, options, progress);
    view_options.stereo = options.stereo;
    view_options.frames_per_second = options.frames_per_second;
    view_options.folder = stage.folder;
    view_options.ghost = stage.ghost;
    view_options.gpu = options.render_gpu;
    Result<std::unique_ptr<HeadlessView>> started = HeadlessView::start(
        stage.scene, run.facts(options.frames_per_second), run.snapshots(), run.rates(), view_options);
    if (!started) {
      Error error = started.error();
      run.snapshots().close();
      error.mend += error.mend.empty() ? "Or run with --no-render" : "; or run with --no-render";
      return error;
    }
    view = std::move(started.value());
    for (const Error& what : view->report().left_out)
      progress.note("slosh: " + what.text() + "; the run goes on without it");
  }

  progress.phase("running");
  run.start();
  {
    RunTerminal terminal(stage, run, progress);
    while (run.running()) {
      terminal.wait(kTurn);
      terminal.turn();
      for (const std::string& line : run.take_notices()) progress.note(line);
      if (interrupted_by() != 0) run.request_stop();
    }
  }
  if (run.exports_waiting() > 0) progress.phase("writing frames");
  for (std::size_t left = run.exports_waiting(); left > 0; left = run.exports_waiting()) {
    progress.update(-1.0, std::to_string(left) + " frames left");
    std::this_thread::sleep_for(kTurn);
  }
  run.stop();

  if (view) {
    progress.phase("encoding");
    while (!view->finished()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const double all = static_cast<double>(view->frames_done() + run.snapshots().waiting());
      const std::string left = std::to_string(run.snapshots().waiting()) + " to draw";
      progress.update(all > 0.0 ? static_cast<double>(view->frames_done()) / all : 0.0, left);
    }
    view->wait();
  }
  run.report(summary);
  if (view) {
    fill_view(summary, *view, view_options, run.snapshots().dropped());
    if (!view->report().refused.empty()) progress.note("slosh: " + view->report().refused);
  }
  return true;
}

}  // namespace slosh
