// Where the views that a person keeps of a scene are.
#pragma once

#include <filesystem>

#include "scenes/scene.h"

namespace slosh {

/// In views/ of the state folder: a shipped scene's by its name, as one's that comes over a network; that of
/// a file of one's own by its path too, so that two scenes of one name keep theirs. Empty where there is no
/// state folder.
std::filesystem::path file_of_views(const Scene& scene);

}  // namespace slosh
