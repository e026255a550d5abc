// The hands of an earlier run, and when it had done each step of its task.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "peer/app/prepare.h"
#include "peer/haptics/script_device.h"

namespace slosh {
namespace {

// By the summary beside the run's poses; none where that is missing or says nothing of a task.
std::vector<double> done_at(const std::filesystem::path& summary) {
  std::ifstream file(summary);
  const nlohmann::json read = nlohmann::json::parse(file, nullptr, false);
  std::vector<double> at;
  if (!read.is_object() || !read.contains("task") || !read["task"].is_array()) return at;
  double time = 0.0;
  for (const nlohmann::json& step : read["task"]) {
    const bool done = step.is_object() && step.contains("took_s") && step["took_s"].is_number();
    if (!done || at.size() >= kMaxTaskSteps) break;
    time += std::clamp(step["took_s"].get<double>(), 0.0, 86400.0);
    at.push_back(time);
  }
  return at;
}

}  // namespace

Result<bool> set_ghost(const ShowOptions& options, Stage& stage) {
  if (options.ghost.empty()) {
    if (options.guide > 0.0)
      return Error{"--guide", "has no ghost to lead to", "Give a run with --ghost too"};
    return true;
  }
  std::error_code unknown;
  std::filesystem::path file = options.ghost;
  if (std::filesystem::is_directory(file, unknown)) file /= "poses.csv";
  stage.ghost_clock = std::make_shared<GhostClock>(done_at(file.parent_path() / "summary.json"));
  std::optional<Error> none;
  for (std::size_t i = 0; i < stage.scene.grips.size(); ++i) {
    Result<std::vector<PoseKey>> way = read_poses(file, static_cast<int>(i));
    if (way)
      stage.ghost.push_back({i, std::move(way.value()), options.guide, stage.ghost_clock});
    else if (!none)
      none = way.error();
  }
  if (stage.ghost.empty() && none) return *none;
  if (stage.ghost.empty()) return Error{"--ghost", "the scene has no grip that a hand could hold", ""};
  return true;
}

}  // namespace slosh
