#include "peer/output/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "net/fresh_file.h"

namespace slosh {
namespace {

/// 0, or the system's number of what went wrong.
int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(file, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(done));
  }
  return 0;
}

Error cannot(const std::filesystem::path& file, const std::string& why) {
  return {file.string(), "cannot be written: " + why,
          "Free some space on its disk, or choose another folder with --out"};
}

}  // namespace

Result<bool> write_whole(const std::filesystem::path& file, std::string_view bytes) {
  const std::filesystem::path part = file.string() + ".part";
  const int out = open_fresh(part.c_str(), 0666);
  if (out < 0) return cannot(file, std::generic_category().message(errno));
  int problem = write_all(out, bytes);
  // Some file systems find only now that there is no room.
  if (close(out) != 0 && problem == 0) problem = errno;
  if (problem == 0 && rename(part.c_str(), file.c_str()) != 0) problem = errno;
  if (problem == 0) return true;
  unlink(part.c_str());
  return cannot(file, std::generic_category().message(problem));
}

}  // namespace slosh
