#include "host/keep/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace slosh::keep {
namespace {

Error failed(const std::filesystem::path& path, const char* what) {
  return {path.string(), std::string(what) + ": " + std::strerror(errno),
          "See that the folder is there, may be written and has room"};
}

bool sync_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return false;
  const bool synced = ::fsync(handle) == 0;
  ::close(handle);
  return synced;
}

}  // namespace

Result<File> open_to_read(const std::filesystem::path& path) {
  struct stat facts{};
  File file(std::fopen(path.c_str(), "rbe"));
  if (!file) return Error{path.string(), std::string("cannot be read: ") + std::strerror(errno), ""};
  if (::fstat(::fileno(file.get()), &facts) != 0 || !S_ISREG(facts.st_mode))
    return Error{path.string(), "is not a file", ""};
  return file;
}

Result<File> open_to_write(const std::filesystem::path& path) {
  const int handle = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (handle < 0) return failed(path, "cannot be written");
  // One that was there keeps its mode on opening.
  ::fchmod(handle, 0600);
  File file(::fdopen(handle, "wb"));
  if (!file) {
    ::close(handle);
    return failed(path, "cannot be written");
  }
  return file;
}

std::filesystem::path previous_of(const std::filesystem::path& path) {
  return path.string() + ".previous";
}

Result<bool> replace_file(const std::filesystem::path& path, ByteView content) {
  const std::filesystem::path fresh = path.string() + ".new";
  Result<File> opened = open_to_write(fresh);
  if (!opened) return opened.error();
  std::FILE* file = opened.value().get();
  const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size() &&
                       std::fflush(file) == 0 && ::fsync(::fileno(file)) == 0;
  if (!written) return failed(fresh, "cannot be written");
  opened.value().reset();
  // A second name for the old file: the first is never missing.
  const std::filesystem::path previous = previous_of(path);
  ::unlink(previous.c_str());
  if (::link(path.c_str(), previous.c_str()) != 0 && errno != ENOENT) {
    // A file system without links: the old one is then gone for a moment, and found under its other name.
    if (::rename(path.c_str(), previous.c_str()) != 0) return failed(path, "cannot be kept");
  }
  if (::rename(fresh.c_str(), path.c_str()) != 0) return failed(path, "cannot be put in place");
  if (!sync_folder(path)) return failed(path, "its folder cannot be brought to the disk");
  return true;
}

}  // namespace slosh::keep
