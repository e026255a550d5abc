// The settings file as defaults of the command line's options.
#pragma once

#include <CLI/App.hpp>
#include <vector>

#include "peer/settings/settings.h"

namespace slosh {

/// Gives the options of every verb of `app` their values from `file`, and says at each which key it has. What
/// an option refuses becomes an error of the file. To be called once all verbs are there and before they are
/// parsed.
void put_in_force(SettingsFile& file, CLI::App& app);

}  // namespace slosh
