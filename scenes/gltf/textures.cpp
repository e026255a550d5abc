#include "scenes/gltf/textures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "net/text/clean.h"
#include "scenes/gltf/buffers.h"

namespace slosh::gltf {
namespace {

using nlohmann::json;

const json kNothing;

const json& field(const json& object, const char* name) {
  if (!object.is_object()) return kNothing;
  const auto found = object.find(name);
  return found == object.end() ? kNothing : *found;
}
const json& entry(const json& list, int index) {
  return list.is_array() && index >= 0 && static_cast<std::size_t>(index) < list.size() ? list[index]
                                                                                        : kNothing;
}

/// A whole number of 0 and more; −1 where there is none.
int natural(const json& value) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > 0x7fffffff) return -1;
  return value.get<int>();
}
double number(const json& value, double otherwise, double least, double most) {
  if (!value.is_number()) return otherwise;
  const double given = value.get<double>();
  return std::isfinite(given) ? std::clamp(given, least, most) : otherwise;
}
glm::dvec2 pair(const json& value, const glm::dvec2& otherwise) {
  if (!value.is_array() || value.size() != 2) return otherwise;
  return {number(value[0], otherwise.x, -1e4, 1e4), number(value[1], otherwise.y, -1e4, 1e4)};
}

TextureWrap wrap(const json& value) {
  const int code = natural(value);
  return code == 33071 ? TextureWrap::kClamp : code == 33648 ? TextureWrap::kMirror : TextureWrap::kRepeat;
}

TextureSampling read_sampling(const json& sampler) {
  TextureSampling out;
  out.wrap_u = wrap(field(sampler, "wrapS"));
  out.wrap_v = wrap(field(sampler, "wrapT"));
  out.nearest = natural(field(sampler, "magFilter")) == 9728;
  const int shrink = natural(field(sampler, "minFilter"));
  if (shrink == 9728 || shrink == 9729) out.shrink = static_cast<TextureShrink>(shrink - 9728);
  if (shrink >= 9984 && shrink <= 9987) out.shrink = static_cast<TextureShrink>(shrink - 9984 + 2);
  return out;
}

TexcoordUse read_texcoords(const json& reference) {
  TexcoordUse out;
  out.set = std::max(natural(field(reference, "texCoord")), 0);
  const json& transform = field(field(reference, "extensions"), "KHR_texture_transform");
  if (!transform.is_object()) return out;
  if (const int set = natural(field(transform, "texCoord")); set >= 0) out.set = set;
  out.offset = pair(field(transform, "offset"), glm::dvec2(0.0));
  const glm::dvec2 scale = pair(field(transform, "scale"), glm::dvec2(1.0));
  const double angle = number(field(transform, "rotation"), 0.0, -1e4, 1e4);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  out.linear = glm::dmat2(glm::dvec2(c, -s) * scale.x, glm::dvec2(s, c) * scale.y);
  return out;
}

std::string named(const Document& document, int material) {
  const json& name = field(entry(field(document.looks, "materials"), material), "name");
  const std::string number = std::string("#").append(std::to_string(material));
  return document.file + ": material '" + (name.is_string() ? name.get<std::string>() : number) + "'";
}

bool base64(const std::string& text, std::size_t from, std::vector<std::uint8_t>& out) {
  std::uint32_t bits = 0;
  int count = 0;
  for (std::size_t i = from; i < text.size() && text[i] != '='; ++i) {
    const char c = text[i];
    const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+' || c == '-' ? 62
                      : c == '/' || c == '_' ? 63
                                             : -1;
    if (digit < 0) return false;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out.push_back(static_cast<std::uint8_t>(bits >> count & 0xff));
  }
  return !out.empty();
}

Error too_large(const std::string& where) {
  return {where, "has more than " + std::to_string(kMaxImageBytes >> 20) + " MB", "Scale the picture down"};
}

}  // namespace

std::optional<TexcoordUse> MaterialUse::texcoords() const {
  for (const TextureUse* use : {&base_color, &metallic_roughness, &normal, &occlusion, &emissive})
    if (use->image >= 0) return use->texcoords;
  return std::nullopt;
}

int material_of(const Document& document, int mesh) {
  for (const tinygltf::Primitive& primitive :
       document.model.meshes[static_cast<std::size_t>(mesh)].primitives)
    if (primitive.material >= 0) return primitive.material;
  return -1;
}

MaterialUse read_material_use(const Document& document, int material, std::vector<Error>* problems) {
  MaterialUse out;
  const json& source = entry(field(document.looks, "materials"), material);
  const auto read = [&](const json& reference, const char* what, const char* factor = "") {
    TextureUse use;
    if (reference.is_null()) return use;
    const json& texture = entry(field(document.looks, "textures"), natural(field(reference, "index")));
    const int image = natural(field(texture, "source"));
    if (entry(field(document.looks, "images"), image).is_object()) {
      use.image = image;
      use.sampling =
          read_sampling(entry(field(document.looks, "samplers"), natural(field(texture, "sampler"))));
      use.texcoords = read_texcoords(reference);
      use.factor = number(field(reference, factor), 1.0, -10.0, 10.0);
    } else if (problems) {
      const bool other = field(texture, "extensions").is_object();
      problems->push_back({named(document, material) + ": " + what + " texture",
                           other ? "is in a form that is not read" : "names no image of the file",
                           "Export images as PNG or JPEG"});
    }
    return use;
  };
  const json& pbr = field(source, "pbrMetallicRoughness");
  out.base_color = read(field(pbr, "baseColorTexture"), "base colour");
  out.metallic_roughness = read(field(pbr, "metallicRoughnessTexture"), "metallic-roughness");
  out.normal = read(field(source, "normalTexture"), "normal", "scale");
  out.occlusion = read(field(source, "occlusionTexture"), "occlusion", "strength");
  out.emissive = read(field(source, "emissiveTexture"), "emissive");
  const json& emission = field(source, "emissiveFactor");
  const double strength =
      number(field(field(field(source, "extensions"), "KHR_materials_emissive_strength"), "emissiveStrength"),
             1.0, 0.0, 1e4);
  for (int c = 0; c < 3; ++c)
    out.emission[c] = std::min(number(entry(emission, c), 0.0, 0.0, 1.0) * strength, 100.0);
  const json& mode = field(source, "alphaMode");
  out.blended = mode == "BLEND";
  if (mode == "MASK") out.mask = number(field(source, "alphaCutoff"), 0.5, 0.0, 1.0);

  // A mesh has one set of texture coordinates here: what needs another is not seen.
  const std::optional<TexcoordUse> used = out.texcoords();
  const auto keep = [&](TextureUse& use, const char* what) {
    if (use.image < 0 || use.texcoords == *used) return;
    use = {};
    if (problems) {
      problems->push_back({named(document, material) + ": " + what + " texture",
                           "lies by other texture coordinates than the material's first",
                           "Give all its textures one UV map and one mapping"});
    }
  };
  keep(out.metallic_roughness, "metallic-roughness");
  keep(out.normal, "normal");
  keep(out.occlusion, "occlusion");
  keep(out.emissive, "emissive");
  return out;
}

Result<SceneImage> read_image(const Document& document, int index) {
  const json& source = entry(field(document.looks, "images"), index);
  const std::string who = "image " + std::to_string(index);
  SceneImage image;
  const json& name = field(source, "name");
  image.name = name.is_string() ? clean_text(name.get<std::string>(), 100) : who;
  const std::string where = document.file + ": image '" + image.name + "'";
  const json& uri = field(source, "uri");
  if (uri.is_string()) {
    const std::string& text = uri.get_ref<const std::string&>();
    if (text.starts_with("data:")) {
      const std::size_t comma = text.find(',');
      if (text.size() / 4 * 3 > kMaxImageBytes) return too_large(where);
      if (comma == std::string::npos ||
          text.substr(0, std::min(comma, std::size_t{200})).find(";base64") == std::string::npos ||
          !base64(text, comma + 1, image.bytes))
        return Error{where, "holds data that are not base64", "Export the file again"};
      return image;
    }
    const Result<std::filesystem::path> found =
        find_own_file(document.file, "image '" + image.name + "'", text);
    if (!found) return found.error();
    std::error_code code;
    const std::uintmax_t size = std::filesystem::file_size(found.value(), code);
    if (!code && size > kMaxImageBytes) return too_large(where);
    image.bytes.resize(code ? 0 : static_cast<std::size_t>(size));
    std::ifstream in(found.value(), std::ios::binary);
    if (code || !in.read(reinterpret_cast<char*>(image.bytes.data()), static_cast<std::streamsize>(size)))
      return Error{where, "cannot be read", "Check its permissions"};
    return image;
  }
  const int view_index = natural(field(source, "bufferView"));
  if (view_index < 0 || static_cast<std::size_t>(view_index) >= document.model.bufferViews.size())
    return Error{where, "has neither a file nor data", "Export the file again"};
  const tinygltf::BufferView& view = document.model.bufferViews[static_cast<std::size_t>(view_index)];
  const std::vector<unsigned char>& buffer =
      document.model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
    return Error{where, "reaches beyond the file's data", "Export the file again"};
  if (view.byteLength > kMaxImageBytes) return too_large(where);
  const auto begin = buffer.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
  image.bytes.assign(begin, begin + static_cast<std::ptrdiff_t>(view.byteLength));
  return image;
}

}  // namespace slosh::gltf
