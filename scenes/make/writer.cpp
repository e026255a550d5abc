#include "scenes/make/writer.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace slosh::make {
namespace {

tinygltf::Value to_value(const nlohmann::json& json) {
  if (json.is_object()) {
    tinygltf::Value::Object object;
    for (const auto& [key, value] : json.items()) object[key] = to_value(value);
    return tinygltf::Value(std::move(object));
  }
  if (json.is_array()) {
    tinygltf::Value::Array array;
    for (const auto& value : json) array.push_back(to_value(value));
    return tinygltf::Value(std::move(array));
  }
  if (json.is_string()) return tinygltf::Value(json.get<std::string>());
  if (json.is_boolean()) return tinygltf::Value(json.get<bool>());
  if (json.is_number_integer()) return tinygltf::Value(json.get<int>());
  return tinygltf::Value(json.get<double>());
}

std::vector<double> to_list(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}
std::vector<double> to_list(const glm::dquat& q) {
  return {q.x, q.y, q.z, q.w};
}

}  // namespace

SceneWriter::SceneWriter(const nlohmann::json& scene_extras) : model_(std::make_unique<tinygltf::Model>()) {
  model_->asset.version = "2.0";
  model_->asset.generator = "slosh-make-scenes";
  model_->buffers.emplace_back();
  model_->scenes.emplace_back();
  model_->scenes[0].extras = to_value(scene_extras);
  model_->defaultScene = 0;
}

SceneWriter::~SceneWriter() = default;
SceneWriter::SceneWriter(SceneWriter&&) noexcept = default;
SceneWriter& SceneWriter::operator=(SceneWriter&&) noexcept = default;

int SceneWriter::add_view(std::span<const std::uint8_t> content, int target) {
  std::vector<unsigned char>& bytes = model_->buffers[0].data;
  bytes.resize((bytes.size() + 3) & ~std::size_t{3});  // what follows an image is aligned, too
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = content.size();
  view.target = target;
  bytes.insert(bytes.end(), content.begin(), content.end());
  model_->bufferViews.push_back(view);
  return static_cast<int>(model_->bufferViews.size()) - 1;
}

int SceneWriter::add_image(const std::string& name, std::span<const std::uint8_t> bytes) {
  tinygltf::Image image;
  image.name = name;
  image.mimeType = !bytes.empty() && bytes[0] == 0xff ? "image/jpeg" : "image/png";
  image.bufferView = add_view(bytes, 0);
  model_->images.push_back(image);
  return static_cast<int>(model_->images.size()) - 1;
}

int SceneWriter::add_texture(const PaintMap& map) {
  if (map.image < 0) return -1;
  constexpr int kWraps[] = {TINYGLTF_TEXTURE_WRAP_REPEAT, TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT,
                            TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE};
  constexpr int kShrinks[] = {9728, 9729, 9984, 9985, 9986, 9987};
  tinygltf::Sampler sampler;
  sampler.wrapS = kWraps[static_cast<std::size_t>(map.sampling.wrap_u)];
  sampler.wrapT = kWraps[static_cast<std::size_t>(map.sampling.wrap_v)];
  sampler.minFilter = kShrinks[static_cast<std::size_t>(map.sampling.shrink)];
  sampler.magFilter = map.sampling.nearest ? TINYGLTF_TEXTURE_FILTER_NEAREST : TINYGLTF_TEXTURE_FILTER_LINEAR;
  tinygltf::Texture texture;
  texture.source = map.image;
  texture.sampler = static_cast<int>(model_->samplers.size());
  model_->samplers.push_back(sampler);
  model_->textures.push_back(texture);
  return static_cast<int>(model_->textures.size()) - 1;
}

int SceneWriter::add_accessor(const std::vector<float>& numbers, int components, bool with_bounds,
                              int target) {
  tinygltf::Accessor accessor;
  accessor.bufferView = add_view(
      {reinterpret_cast<const std::uint8_t*>(numbers.data()), numbers.size() * sizeof(float)}, target);
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  accessor.count = numbers.size() / static_cast<std::size_t>(components);
  constexpr int kTypes[] = {TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4};
  accessor.type = kTypes[components - 1];
  if (with_bounds) {
    accessor.minValues.assign(components, std::numeric_limits<double>::infinity());
    accessor.maxValues.assign(components, -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::size_t c = i % static_cast<std::size_t>(components);
      accessor.minValues[c] = std::min<double>(accessor.minValues[c], numbers[i]);
      accessor.maxValues[c] = std::max<double>(accessor.maxValues[c], numbers[i]);
    }
  }
  model_->accessors.push_back(accessor);
  return static_cast<int>(model_->accessors.size()) - 1;
}

int SceneWriter::add_material(const std::string& name, const Paint& paint) {
  tinygltf::Material material;
  material.name = name;
  material.pbrMetallicRoughness.baseColorFactor = {paint.color.r, paint.color.g, paint.color.b,
                                                   paint.color.a};
  material.pbrMetallicRoughness.metallicFactor = paint.metallic;
  material.pbrMetallicRoughness.roughnessFactor = paint.roughness;
  if (paint.color.a < 1.0) material.alphaMode = "BLEND";
  material.emissiveFactor = to_list(paint.emissive);
  material.pbrMetallicRoughness.baseColorTexture.index = add_texture(paint.base_color_map);
  material.pbrMetallicRoughness.metallicRoughnessTexture.index = add_texture(paint.metallic_roughness_map);
  material.normalTexture.index = add_texture(paint.normal_map);
  material.normalTexture.scale = paint.normal_scale;
  material.occlusionTexture.index = add_texture(paint.occlusion_map);
  material.occlusionTexture.strength = paint.occlusion_strength;
  material.emissiveTexture.index = add_texture(paint.emissive_map);
  model_->materials.push_back(material);
  return static_cast<int>(model_->materials.size()) - 1;
}

int SceneWriter::add_mesh(const std::string& name, const Solid& solid, int material) {
  return add_mesh(name, with_normals(solid), material);
}

int SceneWriter::add_mesh(const std::string& name, const TriangleMesh& triangles, int material) {
  std::vector<float> positions;
  std::vector<float> normals;
  for (std::size_t i = 0; i < triangles.positions.size(); ++i) {
    for (int c = 0; c < 3; ++c) positions.push_back(triangles.positions[i][c]);
    for (int c = 0; c < 3; ++c) normals.push_back(triangles.normals[i][c]);
  }
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = material;
  primitive.attributes["POSITION"] = add_accessor(positions, 3, true, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.attributes["NORMAL"] = add_accessor(normals, 3, false, TINYGLTF_TARGET_ARRAY_BUFFER);
  if (!triangles.texcoords.empty()) {
    std::vector<float> texcoords;
    for (const glm::vec2& t : triangles.texcoords) texcoords.insert(texcoords.end(), {t.x, t.y});
    primitive.attributes["TEXCOORD_0"] = add_accessor(texcoords, 2, false, TINYGLTF_TARGET_ARRAY_BUFFER);
  }
  const auto* indices = reinterpret_cast<const std::uint8_t*>(triangles.triangles.data());
  tinygltf::Accessor accessor;
  accessor.bufferView = add_view({indices, triangles.triangles.size() * sizeof(glm::uvec3)},
                                 TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  accessor.count = 3 * triangles.triangles.size();
  accessor.type = TINYGLTF_TYPE_SCALAR;
  model_->accessors.push_back(accessor);
  primitive.indices = static_cast<int>(model_->accessors.size()) - 1;
  tinygltf::Mesh mesh;
  mesh.name = name;
  mesh.primitives.push_back(primitive);
  model_->meshes.push_back(mesh);
  return static_cast<int>(model_->meshes.size()) - 1;
}

int SceneWriter::add_node(const std::string& name, int mesh, const Pose& pose, const nlohmann::json& extras,
                          int parent) {
  tinygltf::Node node;
  node.name = name;
  node.mesh = mesh;
  node.translation = to_list(pose.position);
  node.rotation = to_list(pose.orientation);
  if (!extras.empty()) node.extras = to_value(extras);
  model_->nodes.push_back(node);
  const int index = static_cast<int>(model_->nodes.size()) - 1;
  if (parent < 0) {
    model_->scenes[0].nodes.push_back(index);
  } else {
    model_->nodes[parent].children.push_back(index);
  }
  return index;
}

void SceneWriter::add_hand(const std::string& name, const std::string& grip,
                           const std::function<Pose(double)>& pose_at, double duration, double rate) {
  animate(add_node(name, -1, pose_at(0.0), {{"slosh", "hand"}, {"grip", grip}}), pose_at, duration, rate);
}

void SceneWriter::animate(int node, const std::function<Pose(double)>& pose_at, double duration,
                          double rate) {
  std::vector<float> times;
  std::vector<float> translations;
  std::vector<float> rotations;
  const int count = static_cast<int>(std::lround(duration * rate));
  glm::dquat last(1.0, 0.0, 0.0, 0.0);
  for (int i = 0; i <= count; ++i) {
    const double time = i / rate;
    Pose pose = pose_at(time);
    if (glm::dot(pose.orientation, last) < 0.0) pose.orientation = -pose.orientation;
    last = pose.orientation;
    times.push_back(static_cast<float>(time));
    for (const double v : to_list(pose.position)) translations.push_back(static_cast<float>(v));
    for (const double v : to_list(pose.orientation)) rotations.push_back(static_cast<float>(v));
  }
  tinygltf::Animation animation;
  animation.name = model_->nodes[static_cast<std::size_t>(node)].name;
  const int input = add_accessor(times, 1, true, 0);
  for (const bool moves : {true, false}) {
    tinygltf::AnimationSampler sampler;
    sampler.input = input;
    sampler.output = moves ? add_accessor(translations, 3, false, 0) : add_accessor(rotations, 4, false, 0);
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation.samplers.size());
    channel.target_node = node;
    channel.target_path = moves ? "translation" : "rotation";
    animation.samplers.push_back(sampler);
    animation.channels.push_back(channel);
  }
  model_->animations.push_back(animation);
}

void SceneWriter::add_camera(const glm::dvec3& eye, const glm::dvec3& target, double vertical_fov_deg) {
  tinygltf::Camera camera;
  camera.type = "perspective";
  camera.perspective.yfov = glm::radians(vertical_fov_deg);
  camera.perspective.aspectRatio = 4.0 / 3.0;
  camera.perspective.znear = 0.02;
  camera.perspective.zfar = 50.0;
  model_->cameras.push_back(camera);
  const glm::dvec3 back = glm::normalize(eye - target);
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), back));
  const glm::dmat3 axes(right, glm::cross(back, right), back);
  const int node = add_node("camera", -1, {eye, glm::normalize(glm::quat_cast(axes))}, {});
  model_->nodes[node].camera = static_cast<int>(model_->cameras.size()) - 1;
}

bool SceneWriter::write(const std::filesystem::path& file) {
  const bool binary = file.extension() == ".glb";
  // Not WriteGltfSceneToFile: that returns true where the file cannot be opened, or the disk is full.
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  if (!out) return false;
  const bool written = tinygltf::TinyGLTF().WriteGltfSceneToStream(model_.get(), out, !binary, binary);
  out.close();  // what is still in its buffer may find no room
  return written && !out.fail();
}

}  // namespace slosh::make
