// The folder that a run writes to: its own, and nobody's results lost.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "sim/math/result.h"

namespace slosh {

/// While a copy of this lives, no other run on this machine takes the folder. Made when it is not there; what
/// was made and is empty when the last copy goes is removed again.
class RunFolder {
 public:
  /// Nowhere: path() is empty.
  RunFolder() = default;

  /// The folder that somebody asked for. `overwrite`: what an earlier run left there is removed first.
  /// Errors: it cannot be made; an earlier run's files are there and are not to be overwritten; another run
  /// writes there now.
  static Result<RunFolder> take(const std::filesystem::path& wanted, bool overwrite);

  /// `wanted` where no run left files and none writes, else `wanted`-2, -3 and so on. Errors: none of these
  /// can be made.
  static Result<RunFolder> take_free(const std::filesystem::path& wanted);

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::shared_ptr<const int> lock_;  // the folder, open and locked
};

/// A name from elsewhere as the name of a folder: ASCII letters and digits and "_", at most 40; everything
/// else becomes "-". `otherwise` where nothing of it is left.
std::string folder_name(std::string_view name, const char* otherwise);

}  // namespace slosh
