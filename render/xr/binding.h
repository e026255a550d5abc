// How a runtime is told whose pictures it gets: one structure a kind of context.
#pragma once

#include <memory>

#include "render/context.h"
#include "render/xr/runtime.h"

namespace slosh::xr {

/// A session on `context`, which is current. Errors: the runtime does not take that kind of context, or
/// refuses the session.
Result<XrSession> make_session(const Runtime& runtime, const Context& context);

}  // namespace slosh::xr
