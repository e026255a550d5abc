// A new file where others may have been before: of a name that they could foresee, in a folder where they may
// write.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

namespace slosh {

/// Makes a file that was not there, for writing, and returns its descriptor; −1 with errno. A file or link of
/// that name, left by a crash or laid there by somebody else, is taken away first and never written through;
/// what is neither, and what is another's to remove, stays: then it is an error.
inline int open_fresh(const char* path, mode_t mode) {
  constexpr int kTries = 8;
  for (int i = 0; i < kTries; ++i) {
    const int file = ::open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    if (file >= 0 || errno != EEXIST) return file;
    struct stat there {};
    if (::lstat(path, &there) != 0) continue;  // it has gone meanwhile
    if (!S_ISREG(there.st_mode) && !S_ISLNK(there.st_mode)) break;
    if (::unlink(path) != 0 && errno != ENOENT) return -1;
  }
  errno = EEXIST;
  return -1;
}

/// Makes a folder that is not there yet, and those above it, for its owner alone whatever the umask. Whether
/// it can be written in is for the first file to say.
inline void make_own_folder(const std::filesystem::path& folder) {
  std::error_code code;
  if (folder.empty() || std::filesystem::exists(folder, code)) return;
  make_own_folder(folder.parent_path());
  ::mkdir(folder.c_str(), 0700);
}

}  // namespace slosh
