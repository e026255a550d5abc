#include "peer/remote/peer_key.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "net/fresh_file.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxBytes = 4096;

std::filesystem::path usual_file() {
  if (const char* data = std::getenv("XDG_DATA_HOME"); data != nullptr && data[0] == '/') {
    return std::filesystem::path(data) / "slosh" / "peer_key";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/') {
    return std::filesystem::path(home) / ".local" / "share" / "slosh" / "peer_key";
  }
  return {};
}

Error trouble(const std::filesystem::path& file, const std::string& what) {
  return {file.string(), what, "Name another file with --key"};
}

bool write_all(int file, const std::vector<std::uint8_t>& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t wrote = write(file, bytes.data() + done, bytes.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    done += static_cast<std::size_t>(wrote);
  }
  return fsync(file) == 0;
}

std::vector<std::uint8_t> read_all(int file) {
  std::vector<std::uint8_t> bytes(kMaxBytes + 1);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = read(file, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

/// The file stays open, and so locked, until the process ends.
Result<Identity> open_locked(const std::filesystem::path& path) {
  make_own_folder(path.parent_path());
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file < 0) return trouble(path, std::string("cannot be opened: ") + std::strerror(errno));
  const auto give_up = [&](const std::string& what) {
    close(file);
    return trouble(path, what);
  };
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    return give_up(errno == EWOULDBLOCK ? "is in use by another running peer"
                                        : std::string("cannot be locked: ") + std::strerror(errno));
  }
  struct stat facts{};
  if (fstat(file, &facts) != 0 || !S_ISREG(facts.st_mode)) return give_up("is not a file");
  // Whoever made it has what it says: they would be this person.
  if (facts.st_uid != geteuid() && geteuid() != 0) return give_up("is another user's file");
  if ((facts.st_mode & (S_IRWXG | S_IRWXO)) != 0 && fchmod(file, S_IRUSR | S_IWUSR) != 0)
    return give_up("can be read by others, and its mode cannot be changed");
  if (facts.st_size == 0) {
    const Identity made = Identity::generate();
    if (!write_all(file, made.private_key())) {
      return give_up(std::string("cannot be written: ") + std::strerror(errno));
    }
    return made;
  }
  const std::vector<std::uint8_t> bytes = read_all(file);
  if (bytes.size() > kMaxBytes) return give_up("is not a key: it is too long");
  Result<Identity> read = Identity::from_private_key(bytes);
  if (!read) return give_up("is not a key: " + read.error().what);
  return read.value();
}

}  // namespace

Result<PeerKey> open_peer_key(const std::filesystem::path& file) {
  const std::filesystem::path path = file.empty() ? usual_file() : file;
  if (path.empty()) {
    return PeerKey{Identity::generate(), false, "there is no home folder to keep your key in"};
  }
  Result<Identity> identity = open_locked(path);
  if (identity) return PeerKey{identity.value(), true, {}};
  if (!file.empty()) return identity.error();
  return PeerKey{Identity::generate(), false,
                 identity.error().where + " " + identity.error().what + ", so this run has a key of its own"};
}

}  // namespace slosh
