// Where the link of `join` and `watch` comes from. A link is a secret, and what stands in a command line
// everybody on the machine can read (`ps`), and a shell remembers: it comes by a prompt, by standard input or
// by a file.
#pragma once

#include <string>

#include "net/wire/messages.h"
#include "sim/math/result.h"

namespace slosh {

/// The text of a link: `given` itself; where that is empty or "-" what standard input says, which is one
/// line, or, at a terminal, what is typed or pasted there, unseen; the file FILE where it is "@FILE", or
/// `file` where that is not empty. A file may be what `slosh host --links` wrote: then a line for `role` is
/// taken, that of `name` where there is one, else the one for anybody. Errors: both given, a file that cannot
/// be read, is too large or has no such line, no input.
Result<std::string> read_link_text(const std::string& given, const std::string& file, wire::Role role,
                                   const std::string& name = {});

/// Puts stars where a link stands in the words of a command line, so that no list of processes shows it.
void hide_links(int count, char** words);

}  // namespace slosh
