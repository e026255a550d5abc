#include "peer/output/recorder.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>

#include "peer/haptics/script_device.h"

namespace slosh {

Result<std::unique_ptr<Recorder>> Recorder::start(Servo& servo, const std::filesystem::path& folder) {
  File wrenches;
  File poses;
  if (!folder.empty()) {
    for (const auto& [file, name, header] : {std::tuple{&wrenches, "wrenches.csv", kWrenchesHeader},
                                             std::tuple{&poses, "poses.csv", kPosesHeader}}) {
      const std::filesystem::path path = folder / name;
      file->reset(std::fopen(path.c_str(), "w"));
      if (!*file) {
        return Error{path.string(),
                     std::string("cannot be written: ") + std::generic_category().message(errno),
                     "Choose another folder with --out"};
      }
      std::fprintf(file->get(), "%s\n", header);
      std::fflush(file->get());
    }
  }
  return std::unique_ptr<Recorder>(new Recorder(servo, std::move(wrenches), std::move(poses)));
}

Recorder::Recorder(Servo& servo, File wrenches, File poses)
    : servo_(servo), wrenches_(std::move(wrenches)), poses_(std::move(poses)), peaks_(servo.devices()) {
  thread_ = std::thread([this] {
    while (!stop_.load(std::memory_order_relaxed)) {
      drain();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
}

Recorder::~Recorder() {
  stop();
}

void Recorder::stop() {
  if (!thread_.joinable()) return;
  stop_.store(true, std::memory_order_relaxed);
  thread_.join();
  drain();
  wrenches_.reset();
  poses_.reset();
}

void Recorder::drain() {
  ServoSample s;
  bool any = false;
  while (servo_.samples().pop(s)) {
    any = true;
    rows_ += 1;
    Peak& peak = peaks_[s.device];
    peak.force = std::max(peak.force, glm::length(s.on_hand.force));
    peak.torque = std::max(peak.torque, glm::length(s.on_hand.torque));
    if (!wrenches_) continue;
    const glm::dvec3& f = s.on_hand.force;
    const glm::dvec3& t = s.on_hand.torque;
    std::fprintf(wrenches_.get(), "%.6f,%u,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", s.time, s.device, f.x, f.y, f.z,
                 t.x, t.y, t.z);
    const glm::dvec3& p = s.handle.position;
    const glm::dquat& q = s.handle.orientation;
    std::fprintf(poses_.get(), "%.6f,%u,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", s.time, s.device, p.x, p.y,
                 p.z, q.w, q.x, q.y, q.z);
  }
  if (any && wrenches_ && (std::fflush(wrenches_.get()) != 0 || std::fflush(poses_.get()) != 0))
    failed_ = true;
}

}  // namespace slosh
