#include "peer/output/run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>
#include <vector>

namespace slosh {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRunFiles[] = {"summary.json", "wrenches.csv", "poses.csv",        "bodies.csv",
                                     "probes.csv",   "wrenches.png", "wrenches.svg",     "wrenches.pdf",
                                     "view.mp4",     "final.png",    "frames/frames.csv"};
constexpr int kMaxFolders = 10'000;
constexpr const char* kAnother = "Choose another folder with --out";

/// A file of an earlier run's in a folder; empty when there is none.
std::string earlier_file(const fs::path& folder) {
  std::error_code code;
  for (const char* name : kRunFiles) {
    if (fs::exists(fs::symlink_status(folder / name, code))) return name;
  }
  return {};
}

/// Whether a name is one that an exporter gives (peer/output/export).
bool is_frame(const std::string& name) {
  return name == "frames.csv" || name == "particles.pvd" || name.starts_with("particles_") ||
         name.starts_with("surface_");
}

/// Removes what an earlier run exported, and the folder where nothing else is in it. The error that there
/// was, if any.
std::error_code remove_frames(const fs::path& folder) {
  std::error_code code;
  std::vector<fs::path> frames;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    if (is_frame(at->path().filename().string())) frames.push_back(at->path());
  }
  if (code == std::errc::no_such_file_or_directory) return {};
  for (const fs::path& frame : frames) {
    if (!code) fs::remove(frame, code);
  }
  std::error_code not_empty;
  fs::remove(folder, not_empty);
  return code;
}

struct Locked {
  std::shared_ptr<const int> lock;
  bool taken = false;  ///< by another run
};

/// Where a file system knows no locks, runs are not kept apart: that is no reason not to run.
///
/// Folders of `made` that are still empty go with the last copy, the deepest first: a run that was refused,
/// or that wrote nothing, leaves none behind.
Locked lock_folder(const fs::path& folder, std::vector<fs::path> made) {
  const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return {};
  if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(file);
    return {nullptr, true};
  }
  return {std::shared_ptr<const int>(new int(file),
                                     [made = std::move(made)](const int* held) {
                                       std::error_code not_empty;
                                       for (auto at = made.rbegin(); at != made.rend() && !not_empty; ++at)
                                         fs::remove(*at, not_empty);
                                       close(*held);
                                       delete held;
                                     }),
          false};
}

/// `made`: the folders that were not there before, the outermost first.
std::optional<Error> make(const fs::path& folder, std::vector<fs::path>& made) {
  std::error_code code;
  made.clear();
  for (fs::path at = folder; !at.empty() && !fs::exists(fs::symlink_status(at, code)); at = at.parent_path())
    made.insert(made.begin(), at);
  fs::create_directories(folder, code);
  if (code || !fs::is_directory(folder))
    return Error{folder.string(), "cannot be made: " + (code ? code.message() : "it is a file"), kAnother};
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    return Error{folder.string(), "cannot be written to: " + std::generic_category().message(errno),
                 kAnother};
  return std::nullopt;
}

}  // namespace

Result<RunFolder> RunFolder::take(const fs::path& wanted, bool overwrite) {
  std::vector<fs::path> made;
  if (const std::optional<Error> problem = make(wanted, made)) return *problem;
  RunFolder folder;
  const Locked locked = lock_folder(wanted, std::move(made));
  if (locked.taken) return Error{wanted.string(), "another run writes there now", kAnother};
  folder.path_ = wanted;
  folder.lock_ = locked.lock;
  if (!overwrite) {
    const std::string found = earlier_file(wanted);
    if (found.empty()) return folder;
    return Error{wanted.string(), "holds an earlier run's " + found,
                 "Choose another folder with --out, or give --overwrite to lose that run"};
  }
  for (const char* name : kRunFiles) {
    std::error_code code;
    fs::remove(wanted / name, code);
    if (code) return Error{(wanted / name).string(), "cannot be overwritten: " + code.message(), kAnother};
  }
  if (const std::error_code code = remove_frames(wanted / "frames"))
    return Error{(wanted / "frames").string(), "cannot be overwritten: " + code.message(), kAnother};
  return folder;
}

Result<RunFolder> RunFolder::take_free(const fs::path& wanted) {
  for (int i = 1; i <= kMaxFolders; ++i) {
    const fs::path one = i == 1 ? wanted : fs::path(wanted.string() + "-" + std::to_string(i));
    std::vector<fs::path> made;
    if (const std::optional<Error> problem = make(one, made)) return *problem;
    const Locked locked = lock_folder(one, std::move(made));
    if (locked.taken || !earlier_file(one).empty()) continue;
    RunFolder folder;
    folder.path_ = one;
    folder.lock_ = locked.lock;
    return folder;
  }
  return Error{wanted.string(), "has " + std::to_string(kMaxFolders) + " runs beside it",
               "Remove some, or choose another folder with --out"};
}

std::string folder_name(std::string_view name, const char* otherwise) {
  constexpr std::size_t kMax = 40;
  std::string out;
  bool any = false;
  for (const char c : name.substr(0, kMax)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    any = any || plain;
    out += plain || c == '_' ? c : '-';
  }
  return any ? out : otherwise;
}

}  // namespace slosh
