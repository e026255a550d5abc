#include "host/keep/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "net/fresh_file.h"

namespace slosh::keep {
namespace {

Error failed(const std::filesystem::path& path, const char* what) {
  return {path.string(), std::string(what) + ": " + std::strerror(errno),
          "See that the folder is there, may be written and has room"};
}

Result<File> as_file(int handle, const std::filesystem::path& path) {
  File file(::fdopen(handle, "wb"));
  if (file) return file;
  const Error error = failed(path, "cannot be written");
  ::close(handle);
  return error;
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
  const int handle = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (handle < 0) return failed(path, "cannot be written");
  struct stat facts{};
  // One that was there keeps its mode on opening, and its owner could go on reading it.
  if (::fstat(handle, &facts) == 0 && S_ISREG(facts.st_mode) &&
      (::fchmod(handle, 0600) != 0 || ::ftruncate(handle, 0) != 0)) {
    const Error error = failed(path, "cannot be made yours alone");
    ::close(handle);
    return error;
  }
  return as_file(handle, path);
}

Result<File> open_fresh_file(const std::filesystem::path& path) {
  const int handle = open_fresh(path.c_str(), 0600);
  return handle < 0 ? Result<File>(failed(path, "cannot be made anew")) : as_file(handle, path);
}

bool bring_to_disk(std::FILE* file) {
  if (std::fflush(file) != 0) return false;
  return ::fsync(::fileno(file)) == 0 || errno == EINVAL;  // a pipe, a device
}

std::filesystem::path previous_of(const std::filesystem::path& path) {
  return path.string() + ".previous";
}

Result<bool> replace_file(const std::filesystem::path& path, ByteView content, Replaced old) {
  const std::filesystem::path fresh = path.string() + ".new";
  Result<File> opened = open_fresh_file(fresh);
  if (!opened) return opened.error();
  std::FILE* file = opened.value().get();
  const bool written =
      std::fwrite(content.data(), 1, content.size(), file) == content.size() && bring_to_disk(file);
  if (!written) return failed(fresh, "cannot be written");
  opened.value().reset();
  if (old == Replaced::kKept) {
    // A second name for the old file, put in place of the one before it at once: neither is ever missing.
    const std::filesystem::path previous = previous_of(path);
    const std::filesystem::path second = previous.string() + ".new";
    ::unlink(second.c_str());
    if (::link(path.c_str(), second.c_str()) == 0) {
      if (::rename(second.c_str(), previous.c_str()) != 0) return failed(path, "cannot be kept");
    } else if (errno != ENOENT && ::rename(path.c_str(), previous.c_str()) != 0) {
      return failed(path, "cannot be kept");
    }
  }
  if (::rename(fresh.c_str(), path.c_str()) != 0) return failed(path, "cannot be put in place");
  if (!sync_folder(path)) return failed(path, "its folder cannot be brought to the disk");
  return true;
}

Result<bool> move_files(const std::filesystem::path& path, const std::filesystem::path& to,
                        std::span<const std::string> endings) {
  const auto named = [](const std::filesystem::path& begin, const std::string& ending) {
    return begin.string() + ending;
  };
  bool linked = true;
  for (const std::string& ending : endings) {
    if (::link(named(path, ending).c_str(), named(to, ending).c_str()) == 0 || errno == ENOENT) continue;
    if (errno == EEXIST) return failed(named(to, ending), "is in the way");
    linked = false;  // no hard links here
    break;
  }
  if (!sync_folder(to)) return failed(to, "its folder cannot be brought to the disk");
  for (const std::string& ending : endings) {
    const std::string from = named(path, ending);
    const int moved = linked ? ::unlink(from.c_str()) : ::rename(from.c_str(), named(to, ending).c_str());
    if (moved != 0 && errno != ENOENT) return failed(from, "cannot be moved aside");
  }
  if (!sync_folder(path)) return failed(path, "its folder cannot be brought to the disk");
  return true;
}

}  // namespace slosh::keep
