// Files that are whole or not there.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "host/keep/chunk.h"

namespace slosh::keep {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// Errors: it cannot be opened, with the system's reason.
Result<File> open_to_read(const std::filesystem::path& path);
/// The file that somebody named, emptied, for its owner alone (mode 0600). Errors: the system's; it is
/// another's.
Result<File> open_to_write(const std::filesystem::path& path);
/// A new file of a name that others can foresee (net/fresh_file.h), for its owner alone. Errors: the
/// system's.
Result<File> open_fresh_file(const std::filesystem::path& path);

/// Writes out what is buffered, and brings it to the disk where the file is on one; false with errno.
bool bring_to_disk(std::FILE* file);

/// What was there before the last replace_file().
std::filesystem::path previous_of(const std::filesystem::path& path);

/// What becomes of the file that is replaced.
enum class Replaced : std::uint8_t {
  kKept,     ///< it is previous_of(path) from now on
  kDropped,  ///< it was of no use: previous_of(path) stays what it was
};

/// Puts a file in place of `path`. A crash between any two steps leaves the old or the new one whole and on
/// the disk, as `path`, or for a moment, on a file system without hard links, as previous_of(path); that one
/// is never replaced by anything but what `path` was. Mode 0600. Errors: it cannot be written.
Result<bool> replace_file(const std::filesystem::path& path, ByteView content,
                          Replaced old = Replaced::kKept);

/// Gives every file of a set, by what follows `path` in its name ("" and ".previous", say), the name that
/// begins with `to` in place of `path`. Those that are not there are passed over. Until the last one has its
/// new name all have the old ones too, so that a crash leaves one of the two sets complete. Errors: one
/// cannot be moved.
Result<bool> move_files(const std::filesystem::path& path, const std::filesystem::path& to,
                        std::span<const std::string> endings);

}  // namespace slosh::keep
