#include "scenes/gltf/roles.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace slosh::gltf {
namespace {

using nlohmann::json;

constexpr int kTriangles = 4;  // of a primitive's modes, those that have faces: 4, 5 and 6

const json& list(const json& object, const char* name) {
  static const json kNone = json::array();
  if (!object.is_object()) return kNone;
  const auto found = object.find(name);
  return found != object.end() && found->is_array() ? *found : kNone;
}

bool names_one_of(const json& value, std::size_t count) {
  return value.is_number_unsigned() && value.get<std::uint64_t>() < count;
}

std::string kind_of(const json& node) {
  if (!node.is_object() || !node.contains("extras") || !node["extras"].is_object()) return {};
  const auto found = node["extras"].find("slosh");
  return found != node["extras"].end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string named(const std::string& file, const char* what, const json& object, std::size_t index) {
  const bool has = object.is_object() && object.contains("name") && object["name"].is_string();
  return file + ": " + what + " '" +
         (has ? object["name"].get<std::string>() : std::string("#").append(std::to_string(index))) + "'";
}

class Looks {
 public:
  Looks(const std::string& file, json& root) : file_(file), root_(root), physical_(physical_meshes(root)) {}

  std::vector<Note> drop() {
    if (!list(root_, "meshes").empty()) {
      for (json& mesh : root_["meshes"])
        if (mesh.is_object()) mesh.erase(kLeftOut);  // it is ours to say
      for (std::size_t m = 0; m < root_["meshes"].size(); ++m) drop_of_mesh(root_["meshes"][m], m);
      leave_out_empty_meshes();
      need_no_compression();
    }
    drop_animations();
    if (coloured_ > 0)
      notes_.push_back(
          {"vertex-colors",
           {file_,
            "vertex colours are not shown, of " + std::to_string(coloured_) + " meshes or parts of them",
            "Bake them into a base colour texture"}});
    return std::move(notes_);
  }

 private:
  /// Whether an accessor can be followed to data.
  bool has_data(const json& value) const {
    const json& accessors = list(root_, "accessors");
    if (!names_one_of(value, accessors.size())) return false;
    const json& accessor = accessors[value.get<std::size_t>()];
    return accessor.is_object() &&
           (accessor.contains("sparse") ||
            (accessor.contains("bufferView") &&
             names_one_of(accessor["bufferView"], list(root_, "bufferViews").size())));
  }

  /// Colours, tangents, joints and whatever exporters add are read by nobody.
  void drop_unread(json& primitive, bool decorates) {
    json& attributes = primitive["attributes"];
    for (auto entry = attributes.begin(); entry != attributes.end();) {
      const std::string& name = entry.key();
      coloured_ += name == "COLOR_0" && has_data(entry.value());
      const bool looks = name.starts_with("TEXCOORD_") || (decorates && name == "NORMAL");
      const bool read = name == "POSITION" || name == "NORMAL" || name.starts_with("TEXCOORD_");
      entry = read && !(looks && !has_data(entry.value())) ? std::next(entry) : attributes.erase(entry);
    }
  }

  bool can_be_drawn(const json& primitive) const {
    if (!primitive.is_object() || !primitive.contains("attributes") || !primitive["attributes"].is_object())
      return false;
    if (primitive.contains("mode") &&
        !(primitive["mode"].is_number_integer() && primitive["mode"] >= kTriangles))
      return false;
    if (is_compressed(primitive)) return false;
    const json& attributes = primitive["attributes"];
    return attributes.contains("POSITION") && has_data(attributes["POSITION"]) &&
           (!primitive.contains("indices") || has_data(primitive["indices"]));
  }

  void drop_of_mesh(json& mesh, std::size_t index) {
    if (list(mesh, "primitives").empty()) return;
    const bool decorates = !physical_[index];
    json& primitives = mesh["primitives"];
    const std::size_t before = primitives.size();
    if (decorates) {
      json kept = json::array();
      for (json& primitive : primitives) {
        compressed_ = compressed_ || is_compressed(primitive);
        if (can_be_drawn(primitive)) kept.push_back(std::move(primitive));
      }
      primitives = std::move(kept);
    }
    for (json& primitive : primitives)
      if (primitive.is_object() && primitive.contains("attributes") && primitive["attributes"].is_object())
        drop_unread(primitive, decorates);
    if (primitives.size() == before) return;
    notes_.push_back(
        {"picture-part",
         {named(file_, "mesh", mesh, index),
          std::to_string(before - primitives.size()) + " of its " + std::to_string(before) +
              " parts cannot be drawn: loose edges or points, compressed, or without data",
          "In Blender: Edit Mode, Select > All by Trait > Loose Geometry, delete it; export without "
          "compression"}});
  }

  void leave_out_empty_meshes() {
    if (list(root_, "nodes").empty()) return;
    json& meshes = root_["meshes"];
    const auto is_empty = [&](std::size_t m) {
      return !physical_[m] && list(meshes[m], "primitives").empty();
    };
    for (json& node : root_["nodes"]) {
      if (!node.is_object() || !node.contains("mesh") || !names_one_of(node["mesh"], meshes.size())) continue;
      if (is_empty(node["mesh"].get<std::size_t>())) node.erase("mesh");
    }
    // Nobody has them any more; their places stay, since nodes name meshes by number.
    for (std::size_t m = 0; m < meshes.size(); ++m)
      if (is_empty(m)) meshes[m] = {{kLeftOut, true}, {"primitives", json::array()}};
  }

  static bool is_compressed(const json& primitive) {
    return primitive.is_object() && primitive.contains("extensions") && primitive["extensions"].is_object() &&
           primitive["extensions"].contains("KHR_draco_mesh_compression");
  }

  /// What was compressed is left out: the rest can be read.
  void need_no_compression() {
    if (!compressed_ || list(root_, "extensionsRequired").empty()) return;
    for (const json& mesh : root_["meshes"])
      if (std::ranges::any_of(list(mesh, "primitives"), is_compressed)) return;
    json kept = json::array();
    for (const json& name : root_["extensionsRequired"])
      if (name != "KHR_draco_mesh_compression") kept.push_back(name);
    root_["extensionsRequired"] = std::move(kept);
  }

  bool moves_something_of_ours(const json& animation) const {
    const json& nodes = list(root_, "nodes");
    return std::ranges::any_of(list(animation, "channels"), [&](const json& channel) {
      if (!channel.is_object() || !channel.contains("target") || !channel["target"].is_object()) return false;
      const json& target = channel["target"];
      return target.contains("node") && names_one_of(target["node"], nodes.size()) &&
             !kind_of(nodes[target["node"].get<std::size_t>()]).empty();
    });
  }

  bool can_be_followed(const json& animation) const {
    const json& samplers = list(animation, "samplers");
    const json& channels = list(animation, "channels");
    return !samplers.empty() && !channels.empty() && std::ranges::all_of(samplers, [&](const json& sampler) {
      return sampler.is_object() && sampler.contains("input") && sampler.contains("output") &&
             has_data(sampler["input"]) && has_data(sampler["output"]);
    }) && std::ranges::all_of(channels, [&](const json& channel) {
      return channel.is_object() && channel.contains("sampler") &&
             names_one_of(channel["sampler"], samplers.size()) && channel.contains("target") &&
             channel["target"].is_object();
    });
  }

  void drop_animations() {
    if (list(root_, "animations").empty()) return;
    json kept = json::array();
    std::size_t index = 0;
    for (json& animation : root_["animations"]) {
      const std::size_t at = index++;
      if (!animation.is_object() || moves_something_of_ours(animation) || can_be_followed(animation)) {
        kept.push_back(std::move(animation));
        continue;
      }
      notes_.push_back(
          {"animation",
           {named(file_, "animation", animation, at), "leads nowhere and moves nothing of the scene",
            "Nothing has to be done; an export without it is smaller"}});
    }
    root_["animations"] = std::move(kept);
  }

  const std::string& file_;
  json& root_;
  std::vector<bool> physical_;
  bool compressed_ = false;  // something that was left out
  std::size_t coloured_ = 0;
  std::vector<Note> notes_;
};

}  // namespace

std::vector<bool> physical_meshes(const nlohmann::json& root) {
  std::vector<bool> physical(list(root, "meshes").size(), false);
  for (const json& node : list(root, "nodes")) {
    const std::string kind = kind_of(node);
    if (kind != "body" && kind != "fluid" && kind != "region") continue;
    if (node.contains("mesh") && names_one_of(node["mesh"], physical.size()))
      physical[node["mesh"].get<std::size_t>()] = true;
  }
  return physical;
}

std::vector<Note> drop_broken_looks(const std::string& file, nlohmann::json& root) {
  return Looks(file, root).drop();
}

}  // namespace slosh::gltf
