// What must hold for every message that decodes.
#pragma once

#include "net/wire/all_messages.h"
#include "tests/fuzz/must.h"
#include "tests/support/randomize.h"

namespace slosh::test {

/// What decodes can be sent on: encoded, nothing has to be brought into range and it decodes again to the
/// same. (Not to the same bytes as came: rotations are brought to length 1.)
template <class M>
void check_decoded(const M& message) {
  wire::Bytes bytes;
  must(!wire::encode(message, bytes), "what was decoded is in range");
  M again{};
  must(!wire::decode(bytes, again), "what was encoded decodes");
  must(wire::encoded(again).size() == bytes.size(), "and has the same size");
}

/// Handles every message of a list, and every fault.
template <class List>
void take(List list, std::uint64_t type, wire::ByteView payload) {
  const wire::Fault fault =
      wire::dispatch(list, type, payload, [](const auto& message) { check_decoded(message); });
  if (fault) must(!fault.field.empty() && wire::text_problem(fault.text()).empty(), "a fault can be told");
}

}  // namespace slosh::test
