#include "scenes/vary.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <optional>

#include "net/text/clean.h"
#include "net/text/nearest.h"
#include "scenes/gltf/document.h"
#include "scenes/reading/reading.h"

namespace slosh {
namespace {

using nlohmann::json;

json json_of(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [at, code] = std::from_chars(text.data(), end, number);
  if (code == std::errc() && at == end) return number;
  return text;
}

std::string kind_of(const json& extras) {
  return extras.contains("slosh") && extras["slosh"].is_string() ? extras["slosh"].get<std::string>()
                                                                 : std::string();
}

bool is_kind(const std::string& name) {
  return name == "body" || name == "fluid" || name == "grip" || name == "hand" || name == "probe";
}

/// Fields that a scene's `fluids` may have in place of the nodes.
bool of_fluid(const std::string& field) {
  return std::find(reading::kFluidFields.begin(), reading::kFluidFields.end(), field) !=
         reading::kFluidFields.end();
}

std::vector<std::string> known_objects(const gltf::Document& document) {
  std::vector<std::string> known{"scene", "body", "fluid", "grip"};
  for (const int node : document.nodes) {
    if (!kind_of(document.extras[node]).empty()) known.push_back(document.name(node));
  }
  return known;
}

std::optional<Error> make_edit(gltf::Document& document, const FieldEdit& edit) {
  const json value = json_of(edit.value);
  if (edit.object == "scene") {
    document.scene_extras[edit.field] = value;
    return std::nullopt;
  }
  bool found = false;
  json& scene = document.scene_extras;
  if (scene.contains("fluids") && scene["fluids"].is_object() && of_fluid(edit.field)) {
    for (auto& [name, fluid] : scene["fluids"].items()) {
      if (edit.object != "fluid" && edit.object != name) continue;
      fluid[edit.field] = value;
      found = true;
    }
  }
  if (found) return std::nullopt;
  for (const int node : document.nodes) {
    json& extras = document.extras[node];
    const std::string kind = kind_of(extras);
    if (kind.empty() || (is_kind(edit.object) ? kind != edit.object : document.name(node) != edit.object))
      continue;
    extras[edit.field] = value;
    found = true;
  }
  if (found) return std::nullopt;
  const std::vector<std::string> known = known_objects(document);
  std::string list;
  for (const std::string& each : known) list += (list.empty() ? "" : ", ") + each;
  return Error{"--set " + edit.object + "." + edit.field, "the scene has no '" + edit.object + "'",
               did_you_mean(edit.object, known) + "Name one of: " + list};
}

Error cleaned(const Error& error) {
  constexpr std::size_t kMax = 2000;
  return {clean_text(error.where, kMax), clean_text(error.what, kMax), clean_text(error.mend, kMax)};
}

}  // namespace

Result<std::vector<FieldEdit>> parse_field_edits(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dot = equals == std::string::npos ? std::string::npos : text.rfind('.', equals);
  // Piece by piece: g++ 12 warns of its own library where a sum begins with a literal.
  std::string said("'");
  said += clean_text(text, kMaxTextBytes);
  said += "' is not OBJECT.FIELD=VALUE,VALUE,…";
  const Error wrong{"--set", said, "For example body.viscosity_pa_s=2,10,20,40"};
  if (dot == std::string::npos || dot == 0 || dot + 1 == equals) return wrong;
  std::vector<FieldEdit> edits;
  for (std::size_t from = equals + 1; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    if (to == from) return wrong;
    edits.push_back(
        {text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(from, to - from)});
    from = to + 1;
  }
  if (edits.empty()) return wrong;
  return edits;
}

Result<Scene> load_scene_with(const std::filesystem::path& file, const std::vector<FieldEdit>& edits) {
  try {
    Result<gltf::Document> document = gltf::read_document(file);
    if (!document) return cleaned(document.error());
    for (const FieldEdit& edit : edits) {
      if (const std::optional<Error> problem = make_edit(document.value(), edit)) return cleaned(*problem);
    }
    std::vector<Error> problems;
    std::vector<gltf::Note> notes;
    std::optional<Scene> scene = reading::read_stages(document.value(), problems, false, &notes);
    if (!scene) return cleaned(problems.front());
    // In a file a stranger's property is nobody's business; here somebody asked for it by name.
    for (const gltf::Note& note : notes) {
      for (const FieldEdit& edit : edits)
        if (note.kind == "foreign-property" && note.text.where.ends_with("extras." + edit.field))
          return cleaned({note.text.where, "is not a property that is known here", note.text.mend});
    }
    return std::move(*scene);
  } catch (const std::exception& problem) {  // out of memory, a library's own
    return cleaned(
        {file.string(), std::string("cannot be read: ") + problem.what(), "Export the file again"});
  }
}

}  // namespace slosh
