// Files that are whole or not there.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>

#include "host/keep/chunk.h"

namespace slosh::keep {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// Errors: it cannot be opened, with the system's reason.
Result<File> open_to_read(const std::filesystem::path& path);
/// A new file that only its owner may read (mode 0600); one that is there is emptied.
Result<File> open_to_write(const std::filesystem::path& path);

/// What was there before the last replace_file().
std::filesystem::path previous_of(const std::filesystem::path& path);

/// Puts a file in place of `path` such that a crash at any moment leaves the old or the new one, whole and on
/// the disk; the old one stays as previous_of(path). Mode 0600. Errors: it cannot be written.
Result<bool> replace_file(const std::filesystem::path& path, ByteView content);

}  // namespace slosh::keep
