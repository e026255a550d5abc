// The bytes of a glTF file, as JSON and binary chunk, before anything looks inside.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/math/result.h"

namespace slosh::gltf {

struct Container {
  nlohmann::json json;    ///< an object; every text in it cleaned (clean_text), but for the uris of buffers
  nlohmann::json images;  ///< the file's "images", of any kind: as they stand, out of `json`
  std::string binary;     ///< a .glb's second chunk; empty for .gltf
  bool is_binary = false;
};

/// Reads a file of at most 512 MB. Errors: missing, empty, too large, truncated .glb, text that is not JSON.
Result<Container> read_container(const std::filesystem::path& file);

/// Whether a file's name ends so; capitals count for nothing. `extension` in small letters, ".glb".
bool has_extension(const std::filesystem::path& file, const char* extension);

/// The container as the bytes of a .glb (is_binary) or of a .gltf.
std::string to_bytes(const Container& container);

}  // namespace slosh::gltf
