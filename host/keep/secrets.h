// What a host must not lose and nobody else may have: its key, the tokens of its links, who sat where. A file
// of its own beside the checkpoint, so that a checkpoint can be given to others.
//
// Eight bytes that name the format, then chunks (chunk.h): head, server_state, end mark. Mode 0600, replaced
// as the checkpoint is, the one before it stays as previous_of().
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "host/keep/chunk.h"

namespace slosh::keep {

struct Secrets {
  std::uint64_t run = 0;  ///< Checkpoint::run of the checkpoint that they belong to
  Bytes server_state;     ///< the server's own
  std::string note;       ///< when not empty: the file was damaged, and these are from the one before it
};

/// Where the secrets of a checkpoint are: "FILE.secrets"; those of its previous_of() are the same.
std::filesystem::path secrets_of(const std::filesystem::path& checkpoint);

/// Errors: the system's.
Result<bool> write_secrets(const std::filesystem::path& checkpoint, std::uint64_t run, ByteView server_state);

/// From a file's current place; `name` is for errors. Errors: it is damaged.
Result<Secrets> read_secrets_file(std::FILE* file, const std::string& name);

/// Nothing when there is no such file. Errors: it and the one before it are damaged.
Result<std::optional<Secrets>> read_secrets(const std::filesystem::path& checkpoint);

}  // namespace slosh::keep
