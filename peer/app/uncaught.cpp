#include "peer/app/uncaught.h"

#include <cstdio>
#include <cstdlib>

#include "net/text/clean.h"
#include "peer/app/verbs.h"

namespace slosh {
namespace {

[[noreturn]] void end() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
    std::fprintf(stderr, "slosh: it was ended by a fault\n");
  } catch (const std::exception& error) {
    fail_uncaught(error);
  } catch (...) {
    std::fprintf(stderr, "slosh: something was thrown that says nothing\n");
  }
  std::abort();
}

}  // namespace

int fail_uncaught(const std::exception& error) {
  std::fprintf(stderr, "slosh: %s\n", clean_lines(error.what(), kMaxTextBytes).c_str());
  return kExitFailed;
}

void say_uncaught_cleanly() {
  std::set_terminate(end);
}

}  // namespace slosh
