// What the programs slosh and slosh-lab have in common: they read a command line and run one verb.
#pragma once

#include <span>

#include "peer/app/verbs.h"

namespace slosh {

using AddVerb = void (*)(CLI::App& app, VerbRun& chosen);

/// The whole of main: says what is wrong with the words, puts the settings in force, and returns the exit
/// code.
int run_program(std::span<const AddVerb> verbs, int argc, char** argv);

}  // namespace slosh
