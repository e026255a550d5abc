#include "scenes/gltf/references.h"

#include "scenes/gltf/roles.h"

namespace slosh::gltf {
namespace {

using nlohmann::json;

const char* const kAgain = "Export the file again";

class ReferenceCheck {
 public:
  ReferenceCheck(const std::string& file, const json& root) : file_(file), root_(root) {}

  std::optional<Error> run() {
    for (const char* list : {"nodes", "meshes", "cameras", "materials", "accessors", "bufferViews", "buffers",
                             "animations", "scenes"}) {
      if (!root_.contains(list)) continue;
      if (!root_[list].is_array()) fail(list, "is not a list");
      for (const json& item : root_[list]) {
        if (!item.is_object()) fail(list, "holds something that is not an object");
      }
    }
    if (error_) return error_;
    each("bufferViews",
         [&](const json& view, const std::string& who) { need(view, "buffer", "buffers", who); });
    each("accessors", [&](const json& accessor, const std::string& who) {
      optional(accessor, "bufferView", "bufferViews", who);
    });
    each("meshes", [&](const json& mesh, const std::string& who) { primitives(mesh, who); });
    each("nodes", [&](const json& node, const std::string& who) {
      optional(node, "mesh", "meshes", who);
      optional(node, "camera", "cameras", who);
      list(node, "children", "nodes", who);
    });
    each("scenes", [&](const json& scene, const std::string& who) { list(scene, "nodes", "nodes", who); });
    optional(root_, "scene", "scenes", "file");
    each("animations", [&](const json& animation, const std::string& who) { channels(animation, who); });
    extensions();
    return error_;
  }

 private:
  void fail(const std::string& who, const std::string& what, const char* mend = kAgain) {
    if (!error_) error_ = Error{file_ + ": " + who, what, mend};
  }

  std::size_t size(const char* list) const { return root_.contains(list) ? root_[list].size() : 0; }

  template <class Visit>
  void each(const char* list, Visit visit) {
    if (!root_.contains(list)) return;
    std::string kind(list);
    kind.pop_back();  // "nodes" → "node"
    if (kind == "meshe") kind = "mesh";
    std::size_t index = 0;
    for (const json& item : root_[list]) {
      std::string who = kind + " " + std::to_string(index++);
      if (item.contains("name") && item["name"].is_string())
        who = kind + " '" + item["name"].get<std::string>() + "'";
      visit(item, who);
    }
  }

  void index(const json& value, const char* list, const std::string& who, const std::string& field) {
    if (value.is_number_unsigned() && value.get<std::uint64_t>() < size(list)) return;
    fail(who + ": " + field, "points at " + value.dump(-1, ' ', false, json::error_handler_t::replace) +
                                 " of " + list + ", of which there are " + std::to_string(size(list)));
  }
  void optional(const json& object, const char* field, const char* list, const std::string& who) {
    if (object.contains(field)) index(object[field], list, who, field);
  }
  void need(const json& object, const char* field, const char* list, const std::string& who) {
    if (!object.contains(field)) return fail(who, std::string("has no ") + field);
    index(object[field], list, who, field);
  }
  void list(const json& object, const char* field, const char* target, const std::string& who) {
    if (!object.contains(field)) return;
    if (!object[field].is_array()) return fail(who + ": " + field, "is not a list");
    for (const json& value : object[field]) index(value, target, who, field);
  }
  /// An accessor that mesh data come from must have a buffer view: the library looks it up unchecked.
  void data(const json& object, const char* field, const std::string& who, const std::string& label) {
    if (!object.contains(field)) return fail(who, "has no " + label);
    index(object[field], "accessors", who, label);
    if (error_) return;
    const json& accessor = root_["accessors"][object[field].get<std::size_t>()];
    const bool needs_view = !accessor.contains("sparse") || label == "indices";
    if (needs_view && !accessor.contains("bufferView"))
      fail(who + ": " + label, "its accessor has no bufferView");
  }

  void primitives(const json& mesh, const std::string& who) {
    if (mesh.contains(kLeftOut)) return;
    if (!mesh.contains("primitives") || !mesh["primitives"].is_array() || mesh["primitives"].empty()) {
      return fail(who, "has no primitives");
    }
    for (const json& primitive : mesh["primitives"]) {
      if (!primitive.is_object() || !primitive.contains("attributes") ||
          !primitive["attributes"].is_object()) {
        return fail(who, "a primitive has no attributes");
      }
      if (primitive.contains("extensions") && primitive["extensions"].is_object() &&
          primitive["extensions"].contains("KHR_draco_mesh_compression")) {
        return fail(who, "is compressed (KHR_draco_mesh_compression)",
                    "Switch compression off in the exporter");
      }
      if (!primitive["attributes"].contains("POSITION")) return fail(who, "has no POSITION");
      for (const auto& [name, value] : primitive["attributes"].items()) {
        data(primitive["attributes"], name.c_str(), who, name);
      }
      if (primitive.contains("indices")) data(primitive, "indices", who, "indices");
      optional(primitive, "material", "materials", who);
    }
  }

  void channels(const json& animation, const std::string& who) {
    for (const char* field : {"channels", "samplers"}) {
      if (!animation.contains(field) || !animation[field].is_array())
        return fail(who, std::string("has no ") + field);
    }
    for (const json& sampler : animation["samplers"]) {
      if (!sampler.is_object()) return fail(who, "a sampler is not an object");
      data(sampler, "input", who, "sampler's input");
      data(sampler, "output", who, "sampler's output");
    }
    for (const json& channel : animation["channels"]) {
      if (!channel.is_object() || !channel.contains("target") || !channel["target"].is_object()) {
        return fail(who, "a channel has no target");
      }
      const std::size_t samplers = animation["samplers"].size();
      if (!channel.contains("sampler") || !channel["sampler"].is_number_unsigned() ||
          channel["sampler"].get<std::uint64_t>() >= samplers) {
        return fail(who, "a channel's sampler is not one of its " + std::to_string(samplers));
      }
      optional(channel["target"], "node", "nodes", who);
    }
  }

  void extensions() {
    if (!root_.contains("extensionsRequired")) return;
    if (!root_["extensionsRequired"].is_array()) return fail("extensionsRequired", "is not a list");
    for (const json& entry : root_["extensionsRequired"]) {
      const std::string name = entry.is_string() ? entry.get<std::string>() : "?";
      const bool looks_only = name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") ||
                              name.starts_with("KHR_lights_") || name.starts_with("EXT_texture_");
      const bool in_the_ledger = name == "KHR_node_visibility" || name == "EXT_mesh_gpu_instancing";
      if (!looks_only && !in_the_ledger && name != "KHR_mesh_quantization") {
        fail("extensionsRequired", "needs the glTF extension '" + name + "', which is not read",
             "Export without compression");
      }
    }
  }

  const std::string& file_;
  const json& root_;
  std::optional<Error> error_;
};

void drop_textures(json& object) {
  if (!object.is_object()) return;
  for (auto entry = object.begin(); entry != object.end();) {
    if (entry.key().ends_with("Texture")) {
      entry = object.erase(entry);
    } else {
      ++entry;
    }
  }
}

}  // namespace

std::optional<Error> check_references(const std::string& file, const nlohmann::json& root) {
  return ReferenceCheck(file, root).run();
}

nlohmann::json take_looks(const nlohmann::json& root) {
  json looks = json::object();
  for (const char* list : {"materials", "textures", "samplers"}) {
    if (root.contains(list)) looks[list] = root[list];
  }
  return looks;
}

void drop_unused(nlohmann::json& root) {
  for (const char* list :
       {"images", "textures", "samplers", "skins", "extensions", "extensionsUsed", "extensionsRequired"}) {
    root.erase(list);
  }
  if (root.contains("nodes")) {
    for (json& node : root["nodes"]) {
      for (const char* field : {"skin", "weights", "extensions", "extras"}) node.erase(field);
    }
  }
  if (root.contains("meshes")) {
    for (json& mesh : root["meshes"]) {
      for (const char* field : {"weights", "extras", "extensions"}) mesh.erase(field);
      for (json& primitive : mesh["primitives"]) {
        for (const char* field : {"targets", "extras", "extensions"}) primitive.erase(field);
      }
    }
  }
  if (root.contains("materials")) {
    for (json& material : root["materials"]) {
      drop_textures(material);
      material.erase("extensions");
      material.erase("extras");
      if (material.contains("pbrMetallicRoughness")) drop_textures(material["pbrMetallicRoughness"]);
    }
  }
}

}  // namespace slosh::gltf
