// The shipped scenes, found by name.
#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "net/text/nearest.h"
#include "scenes/gltf/container.h"
#include "scenes/load.h"

namespace slosh {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOrder[] = {"bucket", "spoon", "pour",  "spin",  "pool",
                                  "probe",  "crepe", "mixer", "vessel"};

/// The folder of the program, or of the library, that this code is in; empty where the system does not say.
fs::path folder_of_this_code() {
  Dl_info found{};
  link_map* map = nullptr;
  const bool known = dladdr1(reinterpret_cast<const void*>(&shipped_scenes), &found,
                             reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) != 0;
  const bool library = known && map && map->l_name && *map->l_name;
  std::error_code code;
  return fs::canonical(library ? fs::path(map->l_name) : fs::path("/proc/self/exe"), code).parent_path();
}

/// As named; else beside what holds this code (a Python package), or where an installation has them from
/// there; else where the build made them.
fs::path scenes_folder() {
  const char* given = std::getenv("SLOSH_SCENES");
  if (given && *given) return given;
  const fs::path here = folder_of_this_code();
  std::error_code code;
  for (const fs::path& folder : {here / "scenes", here.parent_path() / "share" / "slosh" / "scenes"})
    if (!here.empty() && fs::is_directory(folder, code)) return folder;
  return SLOSH_SCENES_FOLDER;
}

bool is_gltf(const fs::path& file) {
  return gltf::has_extension(file, ".gltf") || gltf::has_extension(file, ".glb");
}

std::string read_title(const fs::path& file) {
  try {
    const auto container = gltf::read_container(file);
    if (!container) return "(" + container.error().what + ")";
    const nlohmann::json& json = container.value().json;
    const std::size_t scene = json.value("scene", std::size_t{0});
    return json.at("scenes").at(scene).at("extras").at("title").get<std::string>();
  } catch (const std::exception&) {
    return "";  // a scene needs no title
  }
}

/// Names of the scene files in the folder that `path` names.
std::vector<std::string> scene_files_beside(const fs::path& path) {
  constexpr std::size_t kMax = 1000;
  std::vector<std::string> names;
  std::error_code code;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (fs::directory_iterator it(folder, code), end; !code && it != end && names.size() < kMax;
       it.increment(code)) {
    if (is_gltf(it->path())) names.push_back(it->path().filename().string());
  }
  return names;
}

std::size_t rank(const std::string& name) {
  return static_cast<std::size_t>(std::find(std::begin(kOrder), std::end(kOrder), name) - std::begin(kOrder));
}

}  // namespace

std::vector<SceneEntry> shipped_scenes() {
  std::vector<SceneEntry> entries;
  std::error_code code;
  for (fs::directory_iterator it(scenes_folder(), code), end; !code && it != end; it.increment(code)) {
    if (is_gltf(it->path()))
      entries.push_back({it->path().stem().string(), read_title(it->path()), it->path()});
  }
  std::sort(entries.begin(), entries.end(), [](const SceneEntry& a, const SceneEntry& b) {
    return rank(a.name) != rank(b.name) ? rank(a.name) < rank(b.name) : a.file < b.file;
  });
  return entries;
}

Result<fs::path> find_scene(const std::string& name_or_path) {
  const fs::path path(name_or_path);
  std::error_code code;
  if (is_gltf(path)) {
    if (fs::is_regular_file(path, code)) return path;
    return Error{name_or_path, "there is no such file",
                 did_you_mean(path.filename().string(), scene_files_beside(path)) +
                     "Check the path, or list the shipped scenes with 'slosh scenes'"};
  }
  for (const char* extension : {".gltf", ".glb"}) {
    if (path.has_parent_path() || name_or_path.empty()) break;
    const fs::path file = scenes_folder() / (name_or_path + extension);
    if (fs::is_regular_file(file, code)) return file;
  }
  std::vector<std::string> known;
  std::string names;
  for (const SceneEntry& entry : shipped_scenes()) {
    known.push_back(entry.name);
    names += (names.empty() ? "" : ", ") + entry.name;
  }
  return Error{"scene '" + name_or_path + "'", "is neither a shipped scene nor a .gltf or .glb file",
               names.empty() ? "There are no shipped scenes in " + scenes_folder().string() +
                                   ": build them, or set SLOSH_SCENES"
                             : did_you_mean(name_or_path, known) + "Shipped: " + names};
}

}  // namespace slosh
