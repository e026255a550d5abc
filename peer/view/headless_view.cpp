#include "peer/view/headless_view.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <future>

#include "net/clock.h"
#include "peer/output/video.h"
#include "peer/view/painter.h"
#include "render/context.h"

namespace slosh {

struct HeadlessView::Setup {
  const Scene& scene;
  const HudFacts& facts;
  SnapshotQueue& queue;
  RateLog& rates;
  ViewOptions options;
  std::shared_ptr<std::promise<Result<bool>>> ready;  // shared: it must outlive its own answer
};

Result<std::unique_ptr<HeadlessView>> HeadlessView::start(const Scene& scene, const HudFacts& facts,
                                                          SnapshotQueue& queue, RateLog& rates,
                                                          const ViewOptions& options) {
  std::unique_ptr<HeadlessView> view(new HeadlessView());
  const auto ready = std::make_shared<std::promise<Result<bool>>>();
  std::future<Result<bool>> answer = ready->get_future();
  view->thread_ = std::thread(
      [&, facts, ready, v = view.get()] { v->run({scene, facts, queue, rates, options, ready}); });
  const Result<bool> outcome = answer.get();
  if (!outcome) {
    view->wait();
    return outcome.error();
  }
  return view;
}

HeadlessView::~HeadlessView() {
  wait();
}

void HeadlessView::wait() {
  if (thread_.joinable()) thread_.join();
}

void HeadlessView::run(const Setup& setup) {
  // On Linux a thread has its own nice value, and what it starts (llvmpipe's threads, ffmpeg) takes it over.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);
  const auto done = [this] { finished_.store(true, std::memory_order_release); };
  const ViewOptions& options = setup.options;

  HeadlessOptions headless;
  headless.software_threads = kViewSoftwareThreads;
  headless.gpu = options.gpu;
  Result<std::unique_ptr<Context>> context = make_headless_context(headless);
  if (!context) {
    done();
    setup.ready->set_value(context.error());
    return;
  }
  report_.renderer = context.value()->description();
  Result<std::unique_ptr<Renderer>> created = Renderer::create(*context.value(), options.render);
  if (!created) {
    done();
    setup.ready->set_value(created.error());
    return;
  }
  Renderer& renderer = *created.value();
  Result<std::unique_ptr<Video>> video =
      Video::start(options.folder / "view.mp4", (options.stereo ? 2 : 1) * options.render.width,
                   options.render.height, options.frames_per_second);
  if (!video) {
    done();
    setup.ready->set_value(video.error());
    return;
  }
  Painter painter(setup.scene, setup.facts, renderer);
  painter.show_ghost(options.ghost);
  report_.left_out = painter.left_out();
  SnapshotQueue& queue = setup.queue;
  RateLog& rates = setup.rates;
  setup.ready->set_value(true);

  Image image, still;
  bool recording = true;
  while (!queue.finished()) {
    const SnapshotPointer snapshot = queue.pop(std::chrono::milliseconds(100));
    if (!snapshot) continue;
    const std::int64_t begin_ns = steady_now_ns();
    painter.record(*snapshot);
    const Rates now = rates.at(snapshot->rigid.time);
    if (options.stereo) {
      image = painter.draw_both(*snapshot, now);
    } else {
      painter.draw(*snapshot, now);
      image = renderer.read_back();
    }
    if (still.rgba.empty() && setup.scene.still > 0.0 &&
        snapshot->rigid.time >= setup.scene.still - 0.5 / options.frames_per_second)
      still = image;
    report_.frame_time.add(to_seconds(steady_now_ns() - begin_ns));
    report_.frames += 1;
    if (recording && !video.value()->add(image)) recording = false;  // finish() below says why
    done_.store(report_.frames, std::memory_order_relaxed);
  }
  report_.renderer += where_particles_are_read(renderer);
  report_.fast = renderer.quality() == Quality::kFast;
  report_.refused = renderer.particles_refused();
  const Result<bool> finished = video.value()->finish();
  if (!finished) report_.problem = finished.error().text();
  if (report_.frames > 0) {
    const Result<std::filesystem::path> written =
        write_png(options.folder / "final.png", still.rgba.empty() ? image : still);
    if (!written && report_.problem.empty()) report_.problem = written.error().text();
  }
  done();
}

}  // namespace slosh
