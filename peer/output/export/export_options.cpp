#include "peer/output/export/export_options.h"

#include <algorithm>

#include "net/text/nearest.h"

namespace slosh {

bool is_surface(ExportKind kind) {
  return kind >= ExportKind::kSurfacePly;
}

const char* stem(ExportKind kind) {
  return is_surface(kind) ? "surface" : "particles";
}

const char* extension(ExportKind kind) {
  const std::string_view name = kExportNames[static_cast<std::size_t>(kind)];
  return name.data() + name.find(':') + 1;
}

Result<std::vector<ExportKind>> parse_exports(const std::vector<std::string>& words) {
  std::vector<ExportKind> kinds;
  for (const std::string& word : words) {
    const auto* const found = std::find(kExportNames.begin(), kExportNames.end(), word);
    if (found == kExportNames.end()) {
      std::string all;
      for (const char* name : kExportNames) all += (all.empty() ? "" : ", ") + std::string(name);
      const std::string near = nearest_word(word, {kExportNames.begin(), kExportNames.end()});
      return Error{"--export", "'" + word + "' is nothing that can be written",
                   (near.empty() ? "" : "Did you mean " + near + "? ") + "There are " + all};
    }
    const auto kind = static_cast<ExportKind>(found - kExportNames.begin());
    if (is_surface(kind) && !can_make_surfaces()) {
      return Error{"--export " + word, "this slosh was built without OpenVDB, which makes surfaces",
                   "Install libopenvdb-dev and libboost-dev and build again, or export particles"};
    }
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
  }
  return kinds;
}

}  // namespace slosh
