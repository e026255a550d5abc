// What `slosh --version` says.
#pragma once

#include <string>

namespace slosh {

/// Version, commit, what this build simulates on and whether a GPU answers, libraries. Lines, the last
/// without an end.
std::string version_text();

}  // namespace slosh
