#include "peer/app/find_headset.h"

#include "peer/view/headless_view.h"

namespace slosh {
namespace {

/// A window is to stand beside the headset, and its runtime takes such pictures.
bool wants_mirror(const ShowOptions& options, const Headset& headset) {
  return !options.headless && display_available() && headset.takes_window();
}

}  // namespace

std::unique_ptr<HeadsetView> find_headset(const ShowOptions& options, Progress& progress) {
  if (!options.vr || !options.render) return nullptr;
  Result<std::unique_ptr<HeadsetView>> found = HeadsetView::find(options.headset);
  if (!found) {
    progress.note("slosh: " + found.error().text() + "; the run goes on without it");
    return nullptr;
  }
  const Headset& headset = found.value()->headset();
  if (!wants_mirror(options, headset) && !headset.takes_headless()) {
    progress.note(
        "slosh: headset: the runtime (" + headset.description() +
        ") takes pictures of a window alone, and there is none. Run it with a display; the run goes on "
        "without it");
    return nullptr;
  }
  if (!wants_mirror(options, headset)) set_software_threads(kViewSoftwareThreads);
  progress.note("headset: " + headset.description());
  return std::move(found.value());
}

bool is_film(const ShowOptions& options, bool headset, Progress& progress) {
  if (!options.render) return true;
  if (headset) return false;
  if (options.headless) return true;
  if (display_available()) return false;
  progress.note("slosh: no display here, so the run becomes a film (--headless)");
  return true;
}

std::optional<Error> no_film(const ShowOptions& options, bool film) {
  if (!film || !options.render) return std::nullopt;
  std::optional<Error> missing = no_headless_gl();
  if (missing) missing->mend += "; or run with --no-render";
  return missing;
}

Result<std::unique_ptr<Context>> make_view_context(const std::string& title, int width, int height,
                                                   const ShowOptions& options, const HeadsetView* headset) {
  if (!headset || wants_mirror(options, headset->headset())) return make_window_context(title, width, height);
  HeadlessOptions headless;
  headless.software_threads = kViewSoftwareThreads;
  return make_headless_context(headless);
}

}  // namespace slosh
