#include "scenes/inspect.h"

#include <exception>

#include "net/text/clean.h"
#include "scenes/gltf/container.h"
#include "scenes/inspection/inspection.h"
#include "scenes/reading/reading.h"

namespace slosh {
namespace {

Inspection look(const std::filesystem::path& file) {
  Inspection found;
  const auto fails = [&](const Error& error) { found.errors.push_back({"error", error}); };
  const Result<gltf::Document> document = gltf::read_document(file);
  if (!document) {
    fails(document.error());
    return found;
  }
  const Result<gltf::Container> raw = gltf::read_container(file);
  if (!raw) {
    fails(raw.error());
    return found;
  }
  std::vector<Error> problems;
  std::vector<gltf::Note> notes;
  found.scene = reading::read_stages(document.value(), problems, true, &notes);
  for (gltf::Note& note : notes) found.warnings.push_back({std::move(note.kind), std::move(note.text)});
  for (const Error& problem : problems) fails(problem);
  inspection::look_at_export(raw.value().json, document.value(), found.warnings);
  inspection::look_at_motion(document.value(), found.warnings);
  if (found.scene) inspection::look_at_scene(document.value(), *found.scene, found.warnings);
  return found;
}

/// As load_scene has it.
void clean(std::vector<Finding>& findings) {
  constexpr std::size_t kMax = 2000;
  for (Finding& finding : findings) {
    finding.text = {clean_text(finding.text.where, kMax), clean_text(finding.text.what, kMax),
                    clean_text(finding.text.mend, kMax)};
  }
}

}  // namespace

Inspection inspect_scene(const std::filesystem::path& file) {
  Inspection found;
  try {
    found = look(file);
  } catch (const std::exception& problem) {  // out of memory, a library's own
    found.errors.push_back(
        {"error",
         {file.string(), std::string("cannot be read: ") + problem.what(), "Export the file again"}});
  }
  clean(found.errors);
  clean(found.warnings);
  return found;
}

}  // namespace slosh
