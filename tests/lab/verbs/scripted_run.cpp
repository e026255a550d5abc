#include "tests/lab/verbs/scripted_run.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>

#include "host/task_tap.h"
#include "net/grip_start.h"
#include "peer/haptics/pose_track.h"
#include "peer/output/recorder.h"
#include "sim/math/format.h"

namespace slosh {

ScriptedRun run_scripted(const Scene& scene, report::Setting setting, double seconds,
                         const std::function<void(double)>& tell) {
  setting.model = scene.model;
  setting.support_ratio = scene.support_ratio;
  ScriptedRun run;
  run.hands.resize(scene.grips.size());
  run.poses.resize(scene.grips.size());
  run.centers.resize(scene.grips.size());
  std::vector<PoseTrack> tracks;
  for (std::size_t i = 0; i < scene.grips.size(); ++i)
    tracks.emplace_back(scene.grips[i].hand_motion, grip_start(scene, i));
  {
    report::Trial trial(scene, setting, run.cost);
    const auto hold = [&](double time) {
      for (std::size_t i = 0; i < tracks.size(); ++i) {
        const PoseTrack::Sample sample = tracks[i].at(time);
        HandleInput& handle = trial.handle(i);
        handle.pose = sample.pose;
        handle.twist = sample.twist;
        handle.engaged = true;
      }
    };
    hold(0.0);
    for (std::size_t i = 0; i < tracks.size(); ++i) trial.handle(i).twist = Twist{};
    if (scene.settle > 0.0) trial.settle(scene.settle, true);
    // What the scene's task brings comes here too.
    std::optional<TaskTap> task;
    if (!scene.task.empty()) {
      task.emplace(scene, trial.sampled(), [&trial](const HostCommand& command, const auto& answer) {
        answer(change_world(trial.world(), command));
      });
      task->on_start(trial.world(), {});
    }
    const long steps = std::max(1L, std::lround(seconds / trial.world().plan().time_step));
    for (long step = 0; step < steps; ++step) {
      hold(trial.world().time());
      trial.step();
      if (task) task->after_step(trial.world());
      const BodySnapshot& now = trial.bodies();
      for (std::size_t i = 0; i < tracks.size(); ++i) {
        run.hands[i].time.push_back(now.time);
        run.hands[i].on_hand.push_back(now.grips[i].on_hand);
        run.poses[i].push_back(now.grips[i].handle);
        run.centers[i].push_back(now.bodies[static_cast<std::size_t>(scene.grips[i].body)].center_of_mass);
      }
      if (tell && step % 64 == 0) tell(static_cast<double>(step) / static_cast<double>(steps));
    }
  }
  return run;
}

bool write_wrenches(const std::filesystem::path& file, const ScriptedRun& run) {
  std::ofstream out(file);
  out << kWrenchesHeader << '\n';
  const std::size_t rows = run.hands.empty() ? 0 : run.hands[0].time.size();
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t i = 0; i < run.hands.size(); ++i) {
      const Wrench& w = run.hands[i].on_hand[r];
      out << format("%.6f,%zu,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", run.hands[i].time[r], i, w.force.x, w.force.y,
                    w.force.z, w.torque.x, w.torque.y, w.torque.z);
    }
  }
  return static_cast<bool>(out.flush());
}

}  // namespace slosh
