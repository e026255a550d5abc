#include "peer/app/file_of_views.h"

#include <cstdint>
#include <system_error>

#include "peer/app/state_folder.h"
#include "peer/output/run_folder.h"
#include "scenes/load.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

/// FNV-1a.
std::uint32_t digest(const std::string& bytes) {
  std::uint32_t hash = 2166136261u;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

}  // namespace

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
    name += format("-%08x", digest(path.string()));
  }
  return std::filesystem::path(folder) / "views" / (name + ".json");
}

}  // namespace slosh
