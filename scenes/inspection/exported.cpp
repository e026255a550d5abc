// What an export leaves out or puts elsewhere, and hands that do not move as they should.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "scenes/gltf/accessor.h"
#include "scenes/gltf/animation.h"
#include "scenes/inspection/inspection.h"

namespace slosh::inspection {
namespace {

using nlohmann::json;

/// Those of scenes/FIELDS.md that nobody would give a thing for another purpose.
constexpr std::array kOurs{"slosh",
                           "motion",
                           "mass_kg",
                           "density_kg_m3",
                           "viscosity_pa_s",
                           "stiffness_n_m",
                           "damping_n_s_m",
                           "extinction_per_m",
                           "rotational_stiffness_nm_rad",
                           "center_of_mass_m",
                           "inertia_kg_m2",
                           "particle_density_kg_m3"};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool ours(const std::string& key) {
  return std::find(kOurs.begin(), kOurs.end(), key) != kOurs.end();
}

std::string text_of(const json& object, const char* key) {
  return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : std::string();
}

/// Keys in `extras` that are ours by their name, one after another.
std::string our_keys(const json& owner) {
  std::string list;
  if (!owner.contains("extras") || !owner["extras"].is_object()) return list;
  for (const auto& [key, value] : owner["extras"].items())
    if (ours(key)) list += (list.empty() ? "" : ", ") + key;
  return list;
}

void look_at_capitals(const gltf::Document& document, std::vector<Finding>& warnings) {
  for (const int node : document.nodes) {
    for (const auto& [key, value] : document.extras[node].items()) {
      if (ours(key) || !ours(lower(key))) continue;
      warnings.push_back(
          {"capital",
           {document.owner(node), "its custom property '" + key + "' is not read: ours have small letters",
            "In Blender: Object Properties > Custom Properties, rename it to '" + lower(key) + "'"}});
    }
  }
}

void look_at_mesh_data(const json& file, const gltf::Document& document, std::vector<Finding>& warnings) {
  if (!file.contains("meshes") || !file["meshes"].is_array()) return;
  std::map<int, std::string> keys_of_mesh;
  for (const int node : document.nodes) {
    const int m = document.model.nodes[node].mesh;
    // A linked copy of a thing that is right has the same mesh data; what counts is on the object.
    if (m < 0 || document.extras[node].contains("slosh")) continue;
    const json& mesh = file["meshes"][static_cast<std::size_t>(m)];
    const auto [known, is_new] = keys_of_mesh.try_emplace(m);
    if (is_new) known->second = our_keys(mesh);
    if (known->second.empty()) continue;
    warnings.push_back({"on-mesh-data",
                        {document.owner(node),
                         "its properties (" + known->second + ") are on the mesh data '" +
                             text_of(mesh, "name") + "', where they are not read",
                         "In Blender: put them under Object Properties (the orange square) > Custom "
                         "Properties, not under Object "
                         "Data (the green triangle)"}});
  }
}

void look_for_instances(const gltf::Document& document, std::vector<Finding>& warnings) {
  // A collection instance becomes an empty with copies of what the collection holds: things of ours under an
  // empty that is nobody's, which stand there too.
  for (const int node : document.nodes) {
    const int parent = document.parent[node];
    if (parent < 0 || document.model.nodes[parent].mesh >= 0 || document.extras[parent].contains("slosh"))
      continue;
    const std::string kind = text_of(document.extras[node], "slosh");
    if (kind != "body" && kind != "fluid") continue;
    const std::string name = document.name(node);
    const auto twin = std::find_if(document.nodes.begin(), document.nodes.end(), [&](int other) {
      return other != node && document.model.nodes[other].mesh == document.model.nodes[node].mesh &&
             document.extras[other] == document.extras[node];
    });
    if (twin == document.nodes.end()) continue;
    warnings.push_back({"collection-instance",
                        {document.owner(node),
                         "is there twice: in '" + document.name(parent) +
                             "', which looks like a collection instance, and as itself",
                         "In Blender: Object > Apply > Make Instances Real and give each its name, or hide "
                         "the collection that is "
                         "only there to be instanced and export visible objects only"}});
  }
}

}  // namespace

void look_at_export(const json& file, const gltf::Document& document, std::vector<Finding>& warnings) {
  const bool camera = std::any_of(document.nodes.begin(), document.nodes.end(),
                                  [&](int node) { return document.model.nodes[node].camera >= 0; });
  if (!camera) {
    warnings.push_back({"no-camera",
                        {document.file, "no camera was exported: the view is chosen for you",
                         "In Blender's glTF export: Include > Cameras, with a camera in the scene"}});
  }
  look_at_capitals(document, warnings);
  look_at_mesh_data(file, document, warnings);
  look_for_instances(document, warnings);
}

void look_at_motion(const gltf::Document& document, std::vector<Finding>& warnings) {
  for (const int node : document.nodes) {
    if (text_of(document.extras[node], "slosh") != "hand") continue;
    if (!gltf::is_animated(document, node)) {
      const bool none = document.model.animations.empty();
      warnings.push_back(
          {"no-animation",
           {document.owner(node),
            std::string("the hand does not move: it has 1 key") +
                (none ? "; the file has no animation at all" : ""),
            none ? "In Blender's glTF export: Animation on (and keys on the hand: I > Location & Rotation)"
                 : "Give it keys of its own (I > Location & Rotation), or nothing if it shall hold still"}});
      continue;
    }
    for (const tinygltf::Animation& animation : document.model.animations) {
      for (const tinygltf::AnimationChannel& channel : animation.channels) {
        if (channel.target_node != node || channel.target_path != "translation") continue;
        const tinygltf::AnimationSampler& sampler = animation.samplers[channel.sampler];
        const auto times = gltf::read_numbers(document.model, sampler.input, 1, gltf::Integers::kNone, "");
        if (!times || times.value().size() < 8 || sampler.interpolation != "LINEAR") continue;
        std::vector<double> steps;
        for (std::size_t i = 1; i < times.value().size(); ++i)
          steps.push_back(times.value()[i] - times.value()[i - 1]);
        std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                         steps.end());
        const double step = steps[steps.size() / 2];
        if (step < 1.0 / 55.0 || step > 0.2) continue;  // as fine as the loop wants them, or set by hand
        char text[200];
        std::snprintf(text, sizeof text,
                      "its motion was sampled at %.0f keys a second, joined by straight lines: the hand hums "
                      "at that rate",
                      1.0 / step);
        warnings.push_back(
            {"coarse-keys",
             {document.owner(node), text,
              "In Blender: Output Properties > Frame Rate 60 (Custom), stretch the keys to it, export "
              "again"}});
      }
    }
  }
}

}  // namespace slosh::inspection
