// A viewer without a display: every snapshot becomes a frame of a film, however long drawing takes.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "net/histogram.h"
#include "net/snapshot_queue.h"
#include "peer/haptics/guidance.h"
#include "peer/view/hud/hud.h"
#include "render/image.h"
#include "render/renderer.h"
#include "scenes/scene.h"

namespace slosh {

struct ViewOptions {
  RenderOptions render;             ///< size, filter iterations
  bool stereo = false;              ///< both eyes side by side, each of that size
  double frames_per_second = 30.0;  ///< of the film
  int gpu = -1;                     ///< as HeadlessOptions::gpu
  std::vector<GuidedHand> ghost{};  ///< as FrameBuilder::show_ghost
  std::filesystem::path folder;     ///< gets view.mp4 and final.png (Scene::still); must exist
};

/// What the viewer did; complete after wait().
struct ViewReport {
  std::uint64_t frames = 0;
  Histogram frame_time;  ///< drawing and reading back, s
  std::string renderer;
  bool fast = false;    ///< Quality::kFast
  std::string refused;  ///< why the particles go through main memory, where a GPU steps them; else empty
  std::string problem;  ///< an error's text, empty when all went well
  std::vector<Error> left_out;  ///< of the scene's looks; there when start() returns
};

constexpr int kViewSoftwareThreads = 1;  ///< that a software renderer may take from the simulation

/// Draws on a thread of its own, at low priority: the simulation comes first.
class HeadlessView {
 public:
  /// Returns when the renderer stands. `scene`, `queue` and `rates` must outlive it. Errors: no OpenGL 4.5
  /// through EGL, no ffmpeg.
  static Result<std::unique_ptr<HeadlessView>> start(const Scene& scene, const HudFacts& facts,
                                                     SnapshotQueue& queue, RateLog& rates,
                                                     const ViewOptions& options);
  ~HeadlessView();
  HeadlessView(const HeadlessView&) = delete;
  HeadlessView& operator=(const HeadlessView&) = delete;

  std::uint64_t frames_done() const { return done_.load(std::memory_order_relaxed); }
  /// All pictures are drawn and the film is finished (the queue must be closed for that).
  bool finished() const { return finished_.load(std::memory_order_acquire); }
  void wait();
  const ViewReport& report() const { return report_; }

 private:
  struct Setup;
  HeadlessView() = default;
  void run(const Setup& setup);

  ViewReport report_;
  std::thread thread_;
  std::atomic<std::uint64_t> done_{0};
  std::atomic<bool> finished_{false};
};

}  // namespace slosh
