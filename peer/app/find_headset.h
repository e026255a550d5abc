// What `--vr` comes to on this machine.
#pragma once

#include <memory>
#include <optional>

#include "peer/app/play_options.h"
#include "peer/output/progress.h"
#include "peer/view/headset_view.h"
#include "render/context.h"

namespace slosh {

/// The headset that was asked for. Null where none was, or where it cannot be used: why is told, and the run
/// goes on without it. Before there are threads that read the environment.
std::unique_ptr<HeadsetView> find_headset(const ShowOptions& options, Progress& progress);

/// Whether the run becomes a film, which is told where nobody asked for it: there is neither display nor
/// headset.
bool is_film(const ShowOptions& options, bool headset, Progress& progress);

/// Why there can be no film of it here, before anything is prepared for one. Nothing where it draws none.
std::optional<Error> no_film(const ShowOptions& options, bool film);

/// A window, or for a headset where there is no display (or none is wanted) a context without one.
Result<std::unique_ptr<Context>> make_view_context(const std::string& title, int width, int height,
                                                   const ShowOptions& options, const HeadsetView* headset);

}  // namespace slosh
