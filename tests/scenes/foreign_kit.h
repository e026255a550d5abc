// The cup as somebody else's program might have written it: with a table that is only looked at, a camera,
// and whatever an edit of the JSON makes of that.
#pragma once

#include <set>

#include "scenes/inspect.h"
#include "support.h"

namespace slosh::test {

inline Inspection inspect_foreign(const Edit& edit) {
  const TempFolder folder;
  make::SceneWriter writer = make_cup();
  const int paint = writer.add_material("wood", {});
  writer.add_node("table",
                  writer.add_mesh("table_mesh", make::box({-0.3, -0.05, -0.3}, {0.3, -0.03, 0.3}), paint), {},
                  nlohmann::json::object());
  writer.add_camera({0.3, 0.4, 0.5}, {0.0, 0.05, 0.0}, 40.0);
  EXPECT_TRUE(writer.write(folder / "cup.gltf"));
  nlohmann::json file = read_json(folder / "cup.gltf");
  edit(file);
  write_text(folder / "cup.gltf", file.dump());
  // What a run reads and what check reads are one.
  const Result<Scene> run = load_scene(folder / "cup.gltf");
  Inspection found = inspect_scene(folder / "cup.gltf");
  EXPECT_EQ(static_cast<bool>(run), found.scene.has_value());
  if (run && found.scene) {
    EXPECT_EQ(run.value().left_out.size(), found.scene->left_out.size());
  }
  return found;
}

/// The mesh that a node has, in glTF JSON.
inline nlohmann::json& mesh_of(nlohmann::json& json, const std::string& node) {
  return json["meshes"][node_named(json, node)["mesh"].get<std::size_t>()];
}

inline nlohmann::json& accessor_of(nlohmann::json& json, const std::string& node,
                                   const std::string& attribute) {
  nlohmann::json& primitive = mesh_of(json, node)["primitives"][0];
  const nlohmann::json& index =
      attribute == "indices" ? primitive["indices"] : primitive["attributes"][attribute];
  return json["accessors"][index.get<std::size_t>()];
}

inline std::string all_text(const std::vector<Finding>& findings) {
  std::string all;
  for (const Finding& finding : findings) all += "[" + finding.kind + "] " + finding.text.text() + "\n";
  return all;
}

/// It plays, and says that much of it in words of that kind.
inline Scene expect_note(const std::string& kind, const Edit& edit,
                         std::initializer_list<const char*> words) {
  SCOPED_TRACE(kind);
  const Inspection found = inspect_foreign(edit);
  EXPECT_TRUE(found.errors.empty()) << all_text(found.errors);
  bool there = false;
  for (const Finding& finding : found.warnings) {
    if (finding.kind != kind) continue;
    there = true;
    EXPECT_FALSE(finding.text.mend.empty()) << finding.text.text();
    for (const char* word : words)
      EXPECT_NE(finding.text.text().find(word), std::string::npos)
          << "no '" << word << "' in: " << finding.text.text();
    break;
  }
  EXPECT_TRUE(there) << "no " << kind << " in\n" << all_text(found.warnings);
  // A run says it too.
  if (!found.scene) return {};
  bool told = false;
  for (const Error& what : found.scene->left_out)
    told = told || (words.size() > 0 && what.text().find(*words.begin()) != std::string::npos);
  EXPECT_TRUE(told) << kind;
  return *found.scene;
}

inline std::set<std::string> kinds_of(const Inspection& found) {
  std::set<std::string> all;
  for (const Finding& f : found.errors) all.insert(f.kind);
  for (const Finding& f : found.warnings) all.insert(f.kind);
  return all;
}

}  // namespace slosh::test
