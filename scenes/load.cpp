#include "scenes/load.h"

#include <exception>

#include "net/text/clean.h"
#include "scenes/gltf/document.h"
#include "scenes/reading/reading.h"

namespace slosh {
namespace {

/// Files have names by which a terminal could be told to do something, too.
Error shown(const Error& error) {
  constexpr std::size_t kMax = 2000;
  return {clean_text(error.where, kMax), clean_text(error.what, kMax), clean_text(error.mend, kMax)};
}

Result<Scene> read_scene(const std::filesystem::path& file) {
  const Result<gltf::Document> document = gltf::read_document(file);
  if (!document) return document.error();
  std::vector<Error> problems;
  std::optional<Scene> scene = reading::read_stages(document.value(), problems, false);
  if (!scene) return problems.front();
  return std::move(*scene);
}

}  // namespace

Result<Scene> load_scene(const std::filesystem::path& file) {
  try {
    Result<Scene> scene = read_scene(file);
    if (!scene) return shown(scene.error());
    return scene;
  } catch (
      const std::exception& problem) {  // out of memory, a library's own; never the way of an expected error
    return shown({file.string(), std::string("cannot be read: ") + problem.what(), "Export the file again"});
  }
}

}  // namespace slosh
