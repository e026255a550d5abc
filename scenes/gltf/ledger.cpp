#include "scenes/gltf/ledger.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace slosh::gltf {
namespace {

using nlohmann::json;

/// Material extensions that are read, and those that Blender writes by itself and nobody misses.
const std::set<std::string> kNotMissed{"KHR_materials_emissive_strength", "KHR_materials_specular",
                                       "KHR_materials_ior"};

const json& member(const json& object, const char* name) {
  static const json kNothing;
  if (!object.is_object()) return kNothing;
  const auto found = object.find(name);
  return found == object.end() ? kNothing : *found;
}

std::string text_of(const json& object, const char* name) {
  const json& value = member(object, name);
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::string plural(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

class Ledger {
 public:
  Ledger(const std::string& file, const json& root) : file_(file), root_(root) { find_nodes(); }

  std::vector<Note> write() {
    for (const std::size_t node : nodes_) look_at_node(root_["nodes"][node], node);
    look_at_animations();
    look_at_materials();
    look_at_lights();
    look_at_other_scenes();
    return std::move(notes_);
  }

 private:
  void add(const char* kind, const std::string& where, const std::string& what, const char* mend) {
    notes_.push_back({kind, {file_ + (where.empty() ? "" : ": " + where), what, mend}});
  }

  /// Of the scene that is read; a loop of nodes is somebody else's error.
  void find_nodes() {
    const json& nodes = member(root_, "nodes");
    if (!nodes.is_array()) return;
    std::vector<bool> seen(nodes.size(), false);
    std::vector<std::size_t> todo;
    const json& scenes = member(root_, "scenes");
    if (scenes.is_array() && !scenes.empty()) {
      for (const json& root : member(scenes[root_.value("scene", std::size_t{0})], "nodes"))
        todo.push_back(root.get<std::size_t>());
    } else {
      for (std::size_t i = 0; i < nodes.size(); ++i) todo.push_back(i);
    }
    while (!todo.empty()) {
      const std::size_t at = todo.back();
      todo.pop_back();
      if (seen[at]) continue;
      seen[at] = true;
      nodes_.push_back(at);
      for (const json& child : member(nodes[at], "children")) todo.push_back(child.get<std::size_t>());
    }
    std::sort(nodes_.begin(), nodes_.end());
  }

  std::string named(const char* what, const json& object, std::size_t index) const {
    const std::string name = text_of(object, "name");
    return std::string(what) + " '" + (name.empty() ? std::string("#").append(std::to_string(index)) : name) +
           "'";
  }

  void look_at_node(const json& node, std::size_t index) {
    const std::string who = named("node", node, index);
    const json& extensions = member(node, "extensions");
    if (member(member(extensions, "KHR_node_visibility"), "visible") == json(false))
      add("hidden", who, "is hidden (KHR_node_visibility), and is there all the same",
          "In Blender's glTF export: Include > Visible Objects, or delete it");
    if (extensions.is_object() && extensions.contains("EXT_mesh_gpu_instancing"))
      add("instances", who, "is drawn many times by the exporter's instancing, and read once",
          "In Blender: Object > Apply > Make Instances Real, or export without GPU instancing");
    if (!member(node, "mesh").is_number_unsigned()) return;
    const json& mesh = root_["meshes"][node["mesh"].get<std::size_t>()];
    several_materials_ += materials_of(mesh).size() > 1;
    if (node.contains("skin"))
      add("skin", who, "is bent by bones (a skin), and is read in its rest shape",
          "In Blender: apply the Armature modifier in the pose that is meant");
    const json& own = member(node, "weights");
    const json& weights = own.is_array() ? own : member(mesh, "weights");
    if (!weights.is_array()) return;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (!weights[i].is_number() || std::abs(weights[i].get<double>()) < 1e-6) continue;
      const json& names = member(member(mesh, "extras"), "targetNames");
      const std::string key = names.is_array() && i < names.size() && names[i].is_string()
                                  ? "'" + names[i].get<std::string>() + "'"
                                  : std::to_string(i + 1);
      char weight[32];
      std::snprintf(weight, sizeof weight, "%.3g", weights[i].get<double>());
      add("shape-key", who,
          "its shape key " + key + " has the weight " + weight + ", and its shape is read without",
          "In Blender: Object Data > Shape Keys > New Shape from Mix, delete the others, then Apply all "
          "Shape Keys");
    }
  }

  static std::set<std::size_t> materials_of(const json& mesh) {
    std::set<std::size_t> used;
    for (const json& primitive : member(mesh, "primitives"))
      if (member(primitive, "material").is_number_unsigned())
        used.insert(primitive["material"].get<std::size_t>());
    return used;
  }

  void look_at_animations() {
    const json& animations = member(root_, "animations");
    if (!animations.is_array()) return;
    std::size_t index = 0;
    for (const json& animation : animations) {
      const std::string who = named("animation", animation, index++);
      std::size_t unused = 0;
      std::string first;
      for (const json& channel : animation["channels"]) {
        const json& target = channel["target"];
        const json& node = member(target, "node");
        const bool there = node.is_number_unsigned();
        const std::string kind =
            there ? text_of(member(root_["nodes"][node.get<std::size_t>()], "extras"), "slosh")
                  : std::string();
        // Of what the physics moves keys are an error of their own.
        if (!kind.empty() && kind != "picture") continue;
        ++unused;
        if (first.empty())
          first = there ? named("node", root_["nodes"][node.get<std::size_t>()], node.get<std::size_t>())
                        : "what no node is";
      }
      if (unused == 0) continue;
      add("unused-animation", who,
          plural(unused, "channel moves", "channels move") + " nothing here, the first that of " + first +
              ": only hands (slosh = \"hand\") go by keys",
          "Give an empty slosh = \"hand\" and the keys, where a body is to be led; a picture stands still");
    }
  }

  void look_at_materials() {
    if (several_materials_ > 0)
      add("materials", "",
          plural(several_materials_, "mesh has", "meshes have") +
              " several materials, and each is shown with its first",
          "Separate them: Edit Mode, Mesh > Separate > By Material, where it is only looked at");
    std::map<std::string, std::size_t> extensions;
    const json& materials = member(root_, "materials");
    if (!materials.is_array()) return;
    for (const json& material : materials) {
      const json& own = member(material, "extensions");
      if (!own.is_object()) continue;
      for (const auto& [name, value] : own.items()) extensions[name] += kNotMissed.contains(name) ? 0 : 1;
    }
    std::string names;
    for (const auto& [name, count] : extensions)
      if (count > 0) names += (names.empty() ? "" : ", ") + name;
    if (!names.empty())
      add("material-extensions", "", "materials are shown without " + names,
          "Nothing has to be done; base colour, metallic, roughness, emission and five textures are shown");
  }

  void look_at_lights() {
    std::size_t lights = 0;
    for (const std::size_t node : nodes_)
      lights += member(member(root_["nodes"][node], "extensions"), "KHR_lights_punctual").is_object();
    if (lights > 0)
      add("lights", "", plural(lights, "light is", "lights are") + " not used",
          "Give the scene light_direction, the way the light travels");
  }

  void look_at_other_scenes() {
    const json& scenes = member(root_, "scenes");
    if (!scenes.is_array() || scenes.size() < 2) return;
    const std::size_t read = root_.value("scene", std::size_t{0});
    add("other-scenes", "",
        "holds " + std::to_string(scenes.size()) + " scenes, and " + named("scene", scenes[read], read) +
            " alone is read",
        "In Blender's glTF export: Include > Active Scene, with the one that is meant");
  }

  const std::string& file_;
  const json& root_;
  std::vector<std::size_t> nodes_;
  std::vector<Note> notes_;
  std::size_t several_materials_ = 0;
};

}  // namespace

std::vector<Note> ledger(const std::string& file, const nlohmann::json& root) {
  return shortened(Ledger(file, root).write());
}

std::vector<Note> shortened(std::vector<Note> notes) {
  std::map<std::string, std::size_t> counts;
  for (const Note& note : notes) ++counts[note.kind];
  std::map<std::string, std::size_t> said;
  std::vector<Note> kept;
  for (Note& note : notes) {
    const std::size_t nth = ++said[note.kind];
    if (nth > kMaxOfAKind) continue;
    if (nth == kMaxOfAKind && counts[note.kind] > kMaxOfAKind)
      note.text.what += " (as " + std::to_string(counts[note.kind] - kMaxOfAKind) + " more)";
    kept.push_back(std::move(note));
  }
  return kept;
}

}  // namespace slosh::gltf
