// Where the link of `join` and `watch` comes from. What stands in a command line can be read by everybody on
// the machine (`ps`): a link may come by standard input or a file as well.
#pragma once

#include <string>

#include "net/wire/messages.h"
#include "sim/math/result.h"

namespace slosh {

/// The text of a link: `given` itself; one line of standard input where that is "-"; the file FILE where it
/// is
/// "@FILE", or `file` where that is not empty. A file may be what `slosh host --links` wrote: then the line
/// for `role` is taken. Errors: nothing or both given, a file that cannot be read, is too large or has no
/// such line.
Result<std::string> read_link_text(const std::string& given, const std::string& file, wire::Role role);

}  // namespace slosh
