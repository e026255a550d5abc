#include "scenes/gltf/container.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "net/text/clean.h"

namespace slosh::gltf {
namespace {

constexpr std::uintmax_t kLargestFile = 512ull << 20;
constexpr int kDeepestJson = 64;                  // the library below walks JSON by recursion
constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"

std::uint32_t read_u32(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

void append_u32(std::string& bytes, std::uint32_t value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

Result<std::string> read_bytes(const std::filesystem::path& file) {
  const std::string where = file.string();
  std::error_code code;
  const auto status = std::filesystem::status(file, code);
  if (code || status.type() == std::filesystem::file_type::not_found) {
    return Error{where, "there is no such file",
                 "Check the path, or list the shipped scenes with 'slosh scenes'"};
  }
  if (status.type() != std::filesystem::file_type::regular) {
    return Error{where, "this is not a file", "Name a .gltf or .glb file"};
  }
  const std::uintmax_t size = std::filesystem::file_size(file, code);
  if (code) return Error{where, "cannot be read: " + code.message(), "Check its permissions"};
  if (size > kLargestFile) {
    return Error{where, "the file has " + std::to_string(size >> 20) + " MB, the limit is 512 MB",
                 "Export without textures, and with fewer triangles"};
  }
  std::ifstream in(file, std::ios::binary);
  std::string bytes(size, '\0');
  if (!in || !in.read(bytes.data(), static_cast<std::streamsize>(size))) {
    return Error{where, "cannot be read", "Check its permissions"};
  }
  return bytes;
}

/// How deep brackets go in a JSON text. (The library's own callback would tell, and looks through all of a
/// list at the end of each of its objects: of 80 000 nodes that is half a minute.)
int deepest_nesting(const std::string& text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++depth);
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return deepest;
}

/// What the JSON library says, without the name that it has for it.
std::string words_of(const std::exception& problem) {
  std::string words = problem.what();
  if (const std::size_t end = words.find("] "); words.starts_with('[') && end != std::string::npos)
    words.erase(0, end + 2);
  return clean_text(words, kMaxTextBytes);
}

/// Splits a .glb; `text` receives the JSON chunk.
std::string split_glb(const std::string& bytes, std::string& text, std::string& binary) {
  if (bytes.size() < 20) return "the header is cut off";
  if (read_u32(bytes, 4) != 2)
    return "version " + std::to_string(read_u32(bytes, 4)) + ", version 2 is needed";
  const std::uint64_t total = read_u32(bytes, 8);
  if (total > bytes.size()) {
    return "the header promises " + std::to_string(total) + " bytes, the file has " +
           std::to_string(bytes.size());
  }
  std::uint64_t at = 12;
  for (int chunk = 0; chunk < 2 && at + 8 <= total; ++chunk) {
    const std::uint64_t length = read_u32(bytes, at);
    const std::uint32_t type = read_u32(bytes, at + 4);
    if (length > total - at - 8) return "chunk " + std::to_string(chunk) + " is cut off";
    if (chunk == 0) {
      if (type != kJsonChunk) return "the first chunk is not JSON";
      text = bytes.substr(at + 8, length);
    } else if (type == kBinChunk) {
      binary = bytes.substr(at + 8, length);
    }
    at += 8 + length;
  }
  return "";
}

/// Names, titles and keys are shown, sent and compared later: this is the door where they become fit for it.
void clean_texts(nlohmann::json& value) {
  if (value.is_string()) {
    auto& text = value.get_ref<std::string&>();
    text = clean_text(text, kMaxTextBytes);
  } else if (value.is_array()) {
    for (nlohmann::json& item : value) clean_texts(item);
  } else if (value.is_object()) {
    nlohmann::json cleaned = nlohmann::json::object();
    for (auto& [key, item] : value.items()) {
      clean_texts(item);
      cleaned[clean_text(key, kMaxTextBytes)] = std::move(item);
    }
    value = std::move(cleaned);
  }
}

/// All but the uris of buffers and images, which hold the data themselves or are looked at by find_own_file.
void clean_all_texts(nlohmann::json& root, nlohmann::json& images) {
  std::vector<nlohmann::json> uris;
  const bool has_buffers = root.contains("buffers") && root["buffers"].is_array();
  if (has_buffers) {
    for (nlohmann::json& buffer : root["buffers"]) {
      uris.emplace_back();
      if (buffer.is_object() && buffer.contains("uri")) uris.back().swap(buffer["uri"]);
    }
  }
  if (root.contains("images")) images.swap(root["images"]);  // they may be large
  root.erase("images");
  clean_texts(root);
  for (std::size_t i = 0; i < uris.size(); ++i) {
    if (!uris[i].is_null()) root["buffers"][i]["uri"].swap(uris[i]);
  }
}

/// "2.0" and whatever else is 2.x.
bool is_two(const nlohmann::json& version) {
  if (!version.is_string()) return false;
  const std::string& text = version.get_ref<const std::string&>();
  return text.size() > 2 && text.rfind("2.", 0) == 0 &&
         text.find_first_not_of("0123456789", 2) == std::string::npos;
}

/// What is not glTF 2 is not ours to guess at: names and units may mean something else there. Empty: all is
/// well.
std::string version_problem(const nlohmann::json& json) {
  const auto asset = json.find("asset");
  if (asset == json.end() || !asset->is_object() || !asset->contains("version"))
    return "it does not say that it is glTF 2: asset.version is missing";
  const nlohmann::json& version = (*asset)["version"];
  if (!is_two(version)) return "asset.version is " + version.dump() + ", and glTF \"2.0\" is what is read";
  const auto least = asset->find("minVersion");
  if (least != asset->end() && *least != "2.0")
    return "asset.minVersion is " + least->dump() + ", and glTF \"2.0\" is what is read";
  return {};
}

}  // namespace

bool has_extension(const std::filesystem::path& file, const char* extension) {
  std::string own = file.extension().string();
  for (char& c : own) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return own == extension;
}

Result<Container> read_container(const std::filesystem::path& file) {
  Result<std::string> read = read_bytes(file);
  if (!read) return read.error();
  std::string& bytes = read.value();
  if (bytes.empty()) return Error{file.string(), "the file is empty", "Export the file again"};
  if (bytes.starts_with("version https://git-lfs.github.com/spec/")) {
    return Error{file.string(),
                 "is a pointer of Git LFS, which stands in the file's place: the file is not here yet",
                 "Run 'git lfs pull' in its folder"};
  }
  Container out;
  std::string text;
  if (bytes.size() >= 4 && read_u32(bytes, 0) == kMagic) {
    out.is_binary = true;
    const std::string problem = split_glb(bytes, text, out.binary);
    if (!problem.empty()) return Error{file.string(), "broken .glb: " + problem, "Export the file again"};
  } else {
    text = std::move(bytes);
  }
  const bool too_deep = deepest_nesting(text) > kDeepestJson;
  try {
    if (!too_deep) out.json = nlohmann::json::parse(text);
  } catch (const std::exception& problem) {
    if (!out.is_binary && has_extension(file, ".glb"))
      return Error{file.string(), "is no .glb: it does not begin with glTF", "Export the file again"};
    return Error{file.string(), "unreadable JSON: " + words_of(problem),
                 "Export the file again; glTF has no NaN, no comments and no trailing commas"};
  }
  if (too_deep) {
    return Error{file.string(), "JSON nested deeper than " + std::to_string(kDeepestJson) + " levels",
                 "Remove the nested custom properties"};
  }
  if (!out.json.is_object())
    return Error{file.string(), "the JSON is not an object", "Export the file again"};
  clean_all_texts(out.json, out.images);
  const std::string problem = version_problem(out.json);
  if (!problem.empty()) return Error{file.string(), problem, "Export the file again as glTF 2.0"};
  return out;
}

std::string to_bytes(const Container& container) {
  std::string text = container.json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (!container.is_binary) return text;
  text.resize((text.size() + 3) & ~std::size_t{3}, ' ');
  std::string binary = container.binary;
  binary.resize((binary.size() + 3) & ~std::size_t{3}, '\0');
  const bool has_binary = !binary.empty();
  std::string out;
  append_u32(out, kMagic);
  append_u32(out, 2);
  append_u32(out, static_cast<std::uint32_t>(20 + text.size() + (has_binary ? 8 + binary.size() : 0)));
  append_u32(out, static_cast<std::uint32_t>(text.size()));
  append_u32(out, kJsonChunk);
  out += text;
  if (has_binary) {
    append_u32(out, static_cast<std::uint32_t>(binary.size()));
    append_u32(out, kBinChunk);
    out += binary;
  }
  return out;
}

}  // namespace slosh::gltf
