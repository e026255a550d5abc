#include "scenes/gltf/buffers.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <optional>
#include <system_error>

#include "net/text/clean.h"

namespace slosh::gltf {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = 512ull << 20;
constexpr const char* kOwnFolder =
    "Keep what it names beside the scene or in a folder below it, or export one .glb that holds everything";

bool has_scheme(const std::string& uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string::npos && colon > 0 &&
         std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.';
         });
}

std::string percent_decoded(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto is_hex = [&](std::size_t at) {
      return at < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[at])) != 0;
    };
    if (uri[i] == '%' && is_hex(i + 1) && is_hex(i + 2)) {
      out += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

bool is_below(const fs::path& folder, const fs::path& path) {
  const auto [end, at] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end() && at != path.end();
}

using Files = std::map<std::string, fs::path>;

bool is_ours(const std::string& name, void* files) {
  return static_cast<const Files*>(files)->contains(name);
}

/// tinygltf looks for a name in several places and expands it; ours is found as it is.
std::string as_it_is(const std::string& path, void*) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

bool read_ours(std::vector<unsigned char>* out, std::string* problem, const std::string& name, void* files) {
  const auto found = static_cast<const Files*>(files)->find(name);
  if (found == static_cast<const Files*>(files)->end()) return false;
  std::error_code code;
  const std::uintmax_t size = fs::file_size(found->second, code);
  std::ifstream in(found->second, std::ios::binary);
  if (code || size > kMaxBytes || !in) {
    *problem = "cannot be read";
    return false;
  }
  out->resize(size);
  in.read(reinterpret_cast<char*>(out->data()), static_cast<std::streamsize>(size));
  if (!in) *problem = "cannot be read";
  return static_cast<bool>(in);
}

bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

/// Newer versions of tinygltf ask for a file's size as well.
template <class Callbacks>
void also_size(Callbacks& callbacks) {
  if constexpr (requires { callbacks.GetFileSizeInBytes; }) {
    callbacks.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string& name, void* files) {
      const auto found = static_cast<const Files*>(files)->find(name);
      std::error_code code;
      *size = found == static_cast<const Files*>(files)->end() ? 0 : fs::file_size(found->second, code);
      return *size > 0 && !code;
    };
  }
}
}  // namespace

Result<fs::path> find_own_file(const fs::path& file, const std::string& who, const std::string& uri) {
  const std::string where = file.string() + ": " + who;
  const std::string named = "names '" + clean_text(uri, 100) + "'";
  if (has_scheme(uri))
    return Error{where, named + ", which is neither data nor a file of its own", kOwnFolder};
  const std::string decoded = percent_decoded(uri);
  if (decoded.find('\0') != std::string::npos) return Error{where, named + ", which is no file", kOwnFolder};
  std::error_code code;
  const fs::path folder = fs::canonical(fs::absolute(file, code).parent_path(), code);
  if (code) return Error{where, named + ": " + code.message(), kOwnFolder};
  const fs::path found = fs::weakly_canonical(folder / decoded, code);
  if (code || !is_below(folder, found))
    return Error{where, named + ", which leads out of the scene's own folder", kOwnFolder};
  const fs::file_status status = fs::status(found, code);
  if (status.type() == fs::file_type::not_found)
    return Error{where, named + ", and there is no such file", kOwnFolder};
  if (code || status.type() != fs::file_type::regular)
    return Error{where, named + ", which is not a file", kOwnFolder};
  return found;
}

Result<BufferFiles> BufferFiles::find(const fs::path& file, nlohmann::json& json) {
  BufferFiles out;
  if (!json.contains("buffers")) return out;
  std::uintmax_t bytes = 0;
  std::size_t index = 0;
  for (nlohmann::json& buffer : json["buffers"]) {
    const std::string who = "buffer " + std::to_string(index++);
    if (!buffer.contains("uri")) continue;
    if (!buffer["uri"].is_string())
      return Error{file.string() + ": " + who, "its uri is not a text", "Export the file again"};
    const std::string uri = buffer["uri"].get<std::string>();
    if (uri.starts_with("data:")) continue;
    const Result<fs::path> found = find_own_file(file, who, uri);
    if (!found) return found.error();
    std::error_code code;
    bytes += fs::file_size(found.value(), code);
    if (code || bytes > kMaxBytes) {
      return Error{file.string() + ": " + who, "the buffers have more than 512 MB, or cannot be read",
                   "Export with fewer triangles"};
    }
    const std::string ours = "slosh-buffer-" + std::to_string(index - 1);
    out.files_[ours] = found.value();
    buffer["uri"] = ours;
  }
  return out;
}

void BufferFiles::serve(tinygltf::TinyGLTF& loader) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = is_ours;
  callbacks.ExpandFilePath = as_it_is;
  callbacks.ReadWholeFile = read_ours;
  callbacks.WriteWholeFile = write_nothing;
  also_size(callbacks);
  callbacks.user_data = &files_;
  loader.SetFsCallbacks(callbacks);
}

}  // namespace slosh::gltf
