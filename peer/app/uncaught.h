// What nobody in the program caught: said with what a terminal may show, whatever a library wrote into it.
#pragma once

#include <exception>

namespace slosh {

/// "slosh: <what>" on stderr, cleaned; returns kExitFailed.
int fail_uncaught(const std::exception& error);

/// From now on a thread that ends the program by an exception (std::terminate) says it so too, before the
/// abort: the C++ library's own words hold the exception's as they are.
void say_uncaught_cleanly();

}  // namespace slosh
