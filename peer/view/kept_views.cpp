#include "peer/view/kept_views.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "peer/output/whole_file.h"

namespace slosh {
namespace {

using nlohmann::json;

constexpr double kFarthest = 1e6;  // m
constexpr double kNearest = 1e-6;
constexpr const char* kFormat = "slosh views 1";

std::optional<double> number(const json& from, const char* name, double least, double most) {
  const auto at = from.find(name);
  if (at == from.end() || !at->is_number()) return std::nullopt;
  const double value = *at;
  return value >= least && value <= most ? std::optional(value) : std::nullopt;
}

std::optional<OrbitCamera::Look> look_of(const json& from) {
  if (!from.is_object()) return std::nullopt;
  OrbitCamera::Look look;
  const char* const names[] = {"target_x_m", "target_y_m", "target_z_m"};
  for (int i = 0; i < 3; ++i) {
    const auto value = number(from, names[i], -kFarthest, kFarthest);
    if (!value) return std::nullopt;
    look.target[i] = *value;
  }
  const auto distance = number(from, "distance_m", kNearest, kFarthest);
  const auto azimuth = number(from, "azimuth_rad", -kFarthest, kFarthest);
  const auto elevation = number(from, "elevation_rad", -OrbitCamera::kSteepest, OrbitCamera::kSteepest);
  if (!distance || !azimuth || !elevation) return std::nullopt;
  look.distance = *distance;
  look.azimuth = *azimuth;
  look.elevation = *elevation;
  return look;
}

json json_of(const OrbitCamera::Look& look) {
  return {{"target_x_m", look.target.x}, {"target_y_m", look.target.y}, {"target_z_m", look.target.z},
          {"distance_m", look.distance}, {"azimuth_rad", look.azimuth}, {"elevation_rad", look.elevation}};
}

/// What is wrong with `file`; empty where nothing is. A file that is not there holds nothing.
std::string read(const std::filesystem::path& file, KeptViews::Places& places) {
  std::error_code code;
  if (!std::filesystem::exists(file, code)) return code ? code.message() : "";
  std::ifstream in(file);
  if (!in) return "cannot be opened";
  const json all = json::parse(in, nullptr, false);
  if (!all.is_object() || all.value("format", json()) != kFormat || !all.contains("views") ||
      !all["views"].is_object())
    return "is not a file of views";
  KeptViews::Places found;
  for (const auto& [name, view] : all["views"].items()) {
    const std::size_t place = name.size() == 1 ? static_cast<std::size_t>(name[0] - '1') : KeptViews::kPlaces;
    const std::optional<OrbitCamera::Look> look = look_of(view);
    if (place >= KeptViews::kPlaces || !look) return "holds a view that is none";
    found[place] = look;
  }
  places = found;
  return {};
}

}  // namespace

KeptViews::KeptViews(std::filesystem::path file) : file_(std::move(file)) {
  if (file_.empty()) return;
  if (const std::string wrong = read(file_, places_); !wrong.empty())
    problem_ = file_.string() + " " + wrong + ": views are kept for this run only. Mend it or move it away";
}

Result<bool> KeptViews::keep(std::size_t place, const OrbitCamera::Look& look) {
  places_[place] = look;
  if (file_.empty()) return true;
  if (!problem_.empty()) return Error{"", problem_, ""};
  // What another run has kept meanwhile stays.
  Places all;
  if (!read(file_, all).empty()) all = places_;
  all[place] = look;
  places_ = all;
  json views = json::object();
  for (std::size_t i = 0; i < kPlaces; ++i)
    if (all[i]) views[std::to_string(i + 1)] = json_of(*all[i]);
  std::error_code code;
  std::filesystem::create_directories(file_.parent_path(), code);
  return write_whole(file_, json{{"format", kFormat}, {"views", views}}.dump(2) + "\n");
}

}  // namespace slosh
