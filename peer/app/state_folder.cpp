#include "peer/app/state_folder.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>

#include "peer/output/run_folder.h"
#include "peer/output/whole_file.h"
#include "scenes/load.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxKept = 100;

std::filesystem::path file_of_spacings() {
  const std::string folder = state_folder();
  return folder.empty() ? std::filesystem::path() : std::filesystem::path(folder) / "spacings.json";
}

/// A list of {key, spacing_m}, the oldest first; empty where there is none.
json read_kept() {
  std::ifstream in(file_of_spacings());
  json kept = json::parse(in, nullptr, false);
  return kept.is_array() ? kept : json::array();
}

/// FNV-1a, of the width of its basis.
template <class Hash>
Hash digest(const std::string& bytes, Hash basis, Hash prime) {
  for (const char c : bytes) basis = (basis ^ static_cast<unsigned char>(c)) * prime;
  return basis;
}

bool is_of(const json& entry, const std::string& key) {
  return entry.is_object() && entry.contains("key") && entry["key"] == key;
}

}  // namespace

std::string state_folder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  if (state && *state == '/') return std::string(state) + "/slosh";
  const char* const home = std::getenv("HOME");
  return home && *home == '/' ? std::string(home) + "/.local/state/slosh" : std::string();
}

std::filesystem::path file_of_views(const Scene& scene) {
  const std::string folder = state_folder();
  if (folder.empty()) return {};
  std::string name = folder_name(scene.name, "scene");
  std::error_code code;
  bool shipped = scene.source_file.empty();
  for (const SceneEntry& entry : shipped_scenes())
    shipped = shipped || std::filesystem::equivalent(entry.file, scene.source_file, code);
  if (!shipped) {
    const std::filesystem::path path = std::filesystem::weakly_canonical(scene.source_file, code);
    name += format("-%08x", digest(path.string(), 2166136261u, 16777619u));
  }
  return std::filesystem::path(folder) / "views" / (name + ".json");
}

std::string spacing_key(const std::filesystem::path& scene_file, const std::string& processor,
                        Backend backend, int threads) {
  std::ifstream in(scene_file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  return format("%016llx, %s, %d threads, slosh " SLOSH_VERSION ", ",
                digest(bytes, 14695981039346656037ull, 1099511628211ull), backend_name(backend), threads) +
         processor;
}

std::optional<double> kept_spacing(const std::string& key) {
  for (const json& entry : read_kept()) {
    if (!is_of(entry, key) || !entry.contains("spacing_m") || !entry["spacing_m"].is_number()) continue;
    const double spacing = entry["spacing_m"];
    if (spacing >= 1e-4 && spacing <= 1.0) return spacing;
  }
  return std::nullopt;
}

void keep_spacing(const std::string& key, double spacing) {
  const std::filesystem::path file = file_of_spacings();
  if (file.empty()) return;
  json kept = json::array();
  for (const json& entry : read_kept())
    if (!is_of(entry, key)) kept.push_back(entry);
  kept.push_back({{"key", key}, {"spacing_m", spacing}});
  while (kept.size() > kMaxKept) kept.erase(kept.begin());
  std::error_code code;
  std::filesystem::create_directories(file.parent_path(), code);
  (void)write_whole(file, kept.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace slosh
