// The files that a glTF keeps its buffers in.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/math/result.h"

namespace slosh::gltf {

/// The file that `uri` of `who` (a buffer, an image) names, in `file`'s own folder or below it once links,
/// ".." and %2e are resolved. Errors: it leads elsewhere, a scheme, no such file, not a file.
Result<std::filesystem::path> find_own_file(const std::filesystem::path& file, const std::string& who,
                                            const std::string& uri);

/// A scene may come from a stranger: what it names is opened only where it lies in the scene's own folder or
/// below it, after every "..", every link and every %2e is resolved. tinygltf itself opens nothing.
class BufferFiles {
 public:
  /// Resolves every buffer's `uri` that is not data, and writes a name of ours in its place. `json` has
  /// passed check_references. Errors: a uri that leads elsewhere, a scheme other than data, no such file, not
  /// a file, more than 512 MB in all.
  static Result<BufferFiles> find(const std::filesystem::path& file, nlohmann::json& json);

  /// Has `loader` read these files and no others. This object must outlive the loading.
  void serve(tinygltf::TinyGLTF& loader);

 private:
  std::map<std::string, std::filesystem::path> files_;  ///< by our name
};

}  // namespace slosh::gltf
