// Small scenes to break, and folders to break them in.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "scenes/load.h"
#include "scenes/make/shipped.h"
#include "scenes/make/solid.h"
#include "scenes/make/writer.h"

namespace slosh::test {

/// A folder of its own, gone with the object.
class TempFolder {
 public:
  TempFolder() {
    static std::atomic<int> count{0};
    path_ = std::filesystem::temp_directory_path() /
            ("slosh_scenes_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// A free cup of water with one grip and its hand: every kind of node that a mistake can be made in.
inline make::SceneWriter make_cup(const nlohmann::json& scene_extras = {{"title", "a cup"}},
                                  const make::Solid* cup_solid = nullptr,
                                  const make::Solid* water_solid = nullptr) {
  make::SceneWriter writer(scene_extras);
  const int paint = writer.add_material("paint", {});
  const make::Solid cup = cup_solid ? *cup_solid : make::tank({0.1, 0.1, 0.1}, 0.02);
  const make::Solid water = water_solid ? *water_solid : make::box({-0.05, 0.02, -0.05}, {0.05, 0.09, 0.05});
  const int node = writer.add_node("cup", writer.add_mesh("cup_mesh", cup, paint), {},
                                   {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.5}});
  writer.add_node("water", writer.add_mesh("water_mesh", water, paint), {}, {{"slosh", "fluid"}});
  const Pose grip{{0.0, 0.1, 0.0}, {1.0, 0.0, 0.0, 0.0}};
  writer.add_node("handle", -1, grip, {{"slosh", "grip"}}, node);
  writer.add_hand(
      "hand", "handle", [=](double) { return grip; }, 1.0);
  return writer;
}

inline nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  return nlohmann::json::parse(in);
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// The node of that name in glTF JSON.
inline nlohmann::json& node_named(nlohmann::json& json, const std::string& name) {
  for (nlohmann::json& node : json["nodes"]) {
    if (node.value("name", "") == name) return node;
  }
  throw std::runtime_error("no node " + name);
}

using Edit = std::function<void(nlohmann::json&)>;

/// Loads the cup after an edit of its JSON.
inline Result<Scene> load_edited(const Edit& edit) {
  const TempFolder folder;
  EXPECT_TRUE(make_cup().write(folder / "cup.gltf"));
  nlohmann::json json = read_json(folder / "cup.gltf");
  edit(json);
  write_text(folder / "cup.gltf", json.dump());
  return load_scene(folder / "cup.gltf");
}

/// Expects a failure whose text has every one of `words`, a mend among them.
template <class T>
void expect_error(const Result<T>& result, std::initializer_list<const char*> words) {
  ASSERT_FALSE(static_cast<bool>(result));
  const std::string text = result.error().text();
  for (const char* word : words)
    EXPECT_NE(text.find(word), std::string::npos) << "no '" << word << "' in: " << text;
  EXPECT_FALSE(result.error().mend.empty()) << text;
}

inline void expect_edit_error(const Edit& edit, std::initializer_list<const char*> words) {
  expect_error(load_edited(edit), words);
}

}  // namespace slosh::test
