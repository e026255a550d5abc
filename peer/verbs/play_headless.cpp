#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "peer/verbs/interrupt.h"
#include "peer/verbs/play_modes.h"
#include "peer/verbs/session.h"
#include "peer/view/headless_view.h"

namespace slosh {
namespace {

void fill_view(RunSummary& summary, const HeadlessView& view, const ViewOptions& options,
               std::uint64_t dropped) {
  const ViewReport& report = view.report();
  summary.rendered = true;
  summary.renderer = report.renderer;
  summary.width = options.render.width;
  summary.height = options.render.height;
  summary.frames = report.frames;
  summary.frames_dropped = dropped;
  summary.frame_ms = {1e3 * report.frame_time.percentile(0.5), 1e3 * report.frame_time.percentile(0.99),
                      1e3 * report.frame_time.max()};
  if (report.frames > 0) {
    if (report.problem.empty()) summary.files.insert(summary.files.end(), {"view.mp4", "final.png"});
  }
}

}  // namespace

std::string running_text(const Rates& rates, double seconds) {
  char text[160];
  int used = std::snprintf(text, sizeof text, "%.2f s", rates.time);
  if (seconds < 1e9) used += std::snprintf(text + used, sizeof text - used, " of %.2f s", seconds);
  if (rates.real_time > 0.0) {
    used += std::snprintf(text + used, sizeof text - used, ", real time × %.2f, step %.2f ms",
                          rates.real_time, rates.step_ms);
  }
  if (rates.device_rate > 0.0)
    std::snprintf(text + used, sizeof text - used, ", devices %.0f Hz", rates.device_rate);
  return text;
}

Result<bool> play_headless(const Prepared& prepared, const PlayOptions& options, Progress& progress,
                           RunSummary& summary) {
  Result<DeviceSet> devices = make_devices(prepared.scene, options.devices, false);
  if (!devices) return devices.error();
  progress.phase("settling");
  const double picture_rate = options.render ? options.frames_per_second : 0.0;
  Result<std::unique_ptr<Session>> created =
      Session::create(prepared, std::move(devices.value()), picture_rate);
  if (!created) return created.error();
  Session& session = *created.value();

  std::unique_ptr<HeadlessView> view;
  ViewOptions view_options;
  if (options.render) {
    progress.phase("preparing the picture");
    view_options.render.width = prepared.width;
    view_options.render.height = prepared.height;
    view_options.render.bilateral_iterations = options.bilateral;
    view_options.frames_per_second = options.frames_per_second;
    view_options.folder = prepared.folder;
    Result<std::unique_ptr<HeadlessView>> started =
        HeadlessView::start(prepared.scene, session.facts(picture_rate), session.channel().pictures(),
                            session.rates(), view_options);
    if (!started) {
      Error error = started.error();
      session.channel().pictures().close();
      error.mend += error.mend.empty() ? "Or play with --no-render" : "; or play with --no-render";
      return error;
    }
    view = std::move(started.value());
  }

  progress.phase("running");
  session.start();
  while (session.host().running()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const Rates rates = session.note_rates();
    progress.update(rates.time / prepared.seconds, running_text(rates, prepared.seconds));
    if (interrupted_by() != 0) session.host().request_stop();
  }
  session.stop();

  if (view) {
    progress.phase("encoding");
    while (!view->finished()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const double all = static_cast<double>(view->frames_done() + session.channel().pictures().waiting());
      const std::string left = std::to_string(session.channel().pictures().waiting()) + " pictures left";
      progress.update(all > 0.0 ? static_cast<double>(view->frames_done()) / all : 0.0, left);
    }
    view->wait();
  }
  session.report(summary);
  if (!prepared.folder.empty()) summary.files = {"wrenches.csv", "poses.csv"};
  if (view) {
    fill_view(summary, *view, view_options, session.channel().pictures().dropped());
    if (!view->report().problem.empty()) progress.note("slosh: the film: " + view->report().problem);
  }
  return true;
}

}  // namespace slosh
