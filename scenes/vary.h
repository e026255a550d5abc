// A scene file with some of its custom properties replaced: families of runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sim/math/result.h"

namespace slosh {

/// One property, as "OBJECT.FIELD" and its value.
struct FieldEdit {
  std::string
      object;  ///< a node's name; a kind (body, fluid, grip, hand, probe): all of that kind; or "scene"
  std::string field;  ///< of scenes/FIELDS.md
  std::string value;  ///< a number, true, false, else a text
};

/// "water.viscosity_pa_s=1,2,5" to an edit a value. Errors: no '.', no '=', an empty part.
Result<std::vector<FieldEdit>> parse_field_edits(const std::string& text);

/// As load_scene, with the edits made before anything is checked. A fluid's properties are replaced where the
/// file has them: in the scene's `fluids` or on the nodes. Errors: an object that is not there (the names are
/// listed), and all of load_scene's: a field that nothing reads, a value out of range.
Result<Scene> load_scene_with(const std::filesystem::path& file, const std::vector<FieldEdit>& edits);

}  // namespace slosh
