#include "scenes/gltf/document.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>

#include "net/text/clean.h"
#include "scenes/gltf/buffers.h"
#include "scenes/gltf/container.h"
#include "scenes/gltf/ledger.h"
#include "scenes/gltf/references.h"
#include "scenes/gltf/roles.h"

namespace slosh::gltf {
namespace {

bool keep_no_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
                   int, void*) {
  return true;
}

/// The library's words, of which some hold a whole buffer.
std::string in_a_sentence(std::string words) {
  constexpr char kData[] = ";base64,";
  constexpr std::size_t kShown = 12;
  if (const std::size_t data = words.find(kData); data != std::string::npos && data + kShown < words.size())
    words = words.substr(0, data + sizeof kData - 1 + kShown) + "…";
  words = clean_text(words, kMaxTextBytes);
  while (!words.empty() && (words.back() == ' ' || words.back() == '.' || words.back() == '?'))
    words.pop_back();
  return words;
}

Result<tinygltf::Model> to_model(const std::filesystem::path& file, Container& container) {
  Result<BufferFiles> buffers = BufferFiles::find(file, container.json);
  if (!buffers) return buffers.error();
  const std::string bytes = to_bytes(container);
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_no_image, nullptr);
  buffers.value().serve(loader);
  tinygltf::Model model;
  std::string problem;
  std::string warning;
  const auto length = static_cast<unsigned int>(bytes.size());
  const bool ok =
      container.is_binary
          ? loader.LoadBinaryFromMemory(&model, &problem, &warning,
                                        reinterpret_cast<const unsigned char*>(bytes.data()), length, "")
          : loader.LoadASCIIFromString(&model, &problem, &warning, bytes.data(), length, "");
  if (!ok) {
    return Error{file.string(), "not a valid glTF 2.0 file: " + in_a_sentence(problem),
                 "Export the file again"};
  }
  return model;
}

bool finite(const std::vector<double>& values) {
  for (const double v : values) {
    if (!std::isfinite(v)) return false;
  }
  return true;
}

std::optional<glm::dmat4> local_matrix(const tinygltf::Node& node) {
  const auto sized = [](const std::vector<double>& v, std::size_t n) { return v.empty() || v.size() == n; };
  if (!sized(node.matrix, 16) || !sized(node.translation, 3) || !sized(node.rotation, 4) ||
      !sized(node.scale, 3) || !finite(node.matrix) || !finite(node.translation) || !finite(node.rotation) ||
      !finite(node.scale)) {
    return std::nullopt;
  }
  glm::dmat4 matrix(1.0);
  if (!node.matrix.empty()) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[i];
    return matrix;
  }
  if (!node.translation.empty()) {
    matrix = glm::translate(matrix, {node.translation[0], node.translation[1], node.translation[2]});
  }
  if (!node.rotation.empty()) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (!(glm::length(q) > 1e-6)) return std::nullopt;
    matrix *= glm::mat4_cast(glm::normalize(q));
  }
  if (!node.scale.empty()) matrix = glm::scale(matrix, {node.scale[0], node.scale[1], node.scale[2]});
  return matrix;
}

/// Fills nodes, parent and world, parents first.
std::optional<Error> walk(Document& document) {
  const std::size_t count = document.model.nodes.size();
  document.parent.assign(count, -1);
  document.world.assign(count, glm::dmat4(1.0));
  std::vector<bool> seen(count, false);
  std::vector<int> depth(count, 0);
  std::vector<int> todo;
  if (document.model.scenes.empty()) {
    std::vector<bool> is_child(count, false);
    for (const auto& node : document.model.nodes) {
      for (const int child : node.children) is_child[child] = true;
    }
    for (int i = static_cast<int>(count) - 1; i >= 0; --i) {
      if (!is_child[i]) todo.push_back(i);
    }
  } else {
    const auto& roots = document.model.scenes[document.model.defaultScene].nodes;
    todo.assign(roots.rbegin(), roots.rend());
  }
  while (!todo.empty()) {
    const int index = todo.back();
    todo.pop_back();
    if (seen[index]) {
      return Error{document.owner(index), "hangs on more than one node, or on itself",
                   "Export the file again"};
    }
    seen[index] = true;
    const tinygltf::Node& node = document.model.nodes[index];
    const std::optional<glm::dmat4> local = local_matrix(node);
    if (!local) {
      return Error{document.owner(index),
                   "its translation, rotation, scale or matrix is not finite or not complete",
                   "Give it a valid transform"};
    }
    const int parent = document.parent[index];
    document.world[index] = parent < 0 ? *local : document.world[parent] * *local;
    document.nodes.push_back(index);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      if (document.parent[*child] >= 0) {
        return Error{document.owner(*child), "hangs on more than one node", "Export the file again"};
      }
      document.parent[*child] = index;
      depth[*child] = depth[index] + 1;
      if (depth[*child] > kDeepestNodes) {
        return Error{document.owner(*child),
                     "lies below more than " + std::to_string(kDeepestNodes) + " nodes",
                     "In Blender: Object > Parent > Clear and Keep Transformation"};
      }
      todo.push_back(*child);
    }
  }
  return std::nullopt;
}

}  // namespace

std::string Document::name(int node) const {
  const std::string& given = model.nodes[node].name;
  return given.empty() ? std::string("#").append(std::to_string(node)) : given;
}

std::string Document::owner(int node) const {
  return file + ": node '" + name(node) + "'";
}

Result<Document> read_document(const std::filesystem::path& file) {
  Result<Container> container = read_container(file);
  if (!container) return container.error();
  nlohmann::json& json = container.value().json;
  Document document;
  document.file = file.string();
  document.notes = drop_broken_looks(document.file, json);
  if (const auto problem = check_references(document.file, json)) return *problem;
  for (Note& note : ledger(document.file, json)) document.notes.push_back(std::move(note));

  document.extras.assign(json.contains("nodes") ? json["nodes"].size() : 0, nlohmann::json::object());
  for (std::size_t i = 0; i < document.extras.size(); ++i) {
    const nlohmann::json& node = json["nodes"][i];
    if (node.contains("extras") && node["extras"].is_object()) document.extras[i] = node["extras"];
  }
  document.scene_extras = nlohmann::json::object();
  if (json.contains("scenes") && !json["scenes"].empty()) {
    const nlohmann::json& scene = json["scenes"][json.value("scene", std::size_t{0})];
    if (scene.contains("extras") && scene["extras"].is_object()) document.scene_extras = scene["extras"];
  }
  document.looks = take_looks(json);
  document.looks["images"] = std::move(container.value().images);
  const nlohmann::json used = json.value("extensionsUsed", nlohmann::json::array());
  document.quantized = std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
  drop_unused(json);
  Result<tinygltf::Model> model = to_model(file, container.value());
  if (!model) return model.error();
  document.model = std::move(model.value());
  if (document.extras.size() != document.model.nodes.size()) {
    return Error{document.file, "its nodes cannot be read", "Export the file again"};
  }
  document.model.defaultScene = std::max(document.model.defaultScene, 0);
  if (const auto problem = walk(document)) return *problem;
  document.animated.assign(document.model.nodes.size(), false);
  for (const tinygltf::Animation& animation : document.model.animations) {
    for (const tinygltf::AnimationChannel& channel : animation.channels)
      if (channel.target_node >= 0) document.animated[static_cast<std::size_t>(channel.target_node)] = true;
  }
  return document;
}

bool split_rotation(const glm::dmat3& linear, glm::dquat& rotation, glm::dmat3& rest) {
  const double size = std::cbrt(std::abs(glm::determinant(linear)));
  if (!(size > 1e-9) || !std::isfinite(size)) return false;
  // Polar decomposition by Newton's iteration (Higham 1986): the nearest rotation.
  glm::dmat3 r = linear / size;
  if (glm::determinant(r) < 0.0) r = -r;  // a mirror goes into the rest
  for (int i = 0; i < 60; ++i) {
    const glm::dmat3 next = 0.5 * (r + glm::transpose(glm::inverse(r)));
    double change = 0.0;
    for (int c = 0; c < 3; ++c) change += glm::length(next[c] - r[c]);
    r = next;
    if (change < 1e-14) break;
  }
  rotation = glm::normalize(glm::quat_cast(r));
  rest = glm::transpose(glm::mat3_cast(rotation)) * linear;
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < 3; ++k) {
      if (!std::isfinite(rest[c][k])) return false;
    }
  }
  return true;
}

}  // namespace slosh::gltf
