#include "net/wire/fields.h"

namespace slosh::wire {

void Reader::text(std::string_view name, std::string& value, std::size_t most) {
  std::uint64_t count = 0;
  if (!varint(name, count)) return;
  if (count > most) return fail(name, std::to_string(count) + " bytes are above " + std::to_string(most));
  if (count > left()) return fail(name, "ends too early");
  value.assign(reinterpret_cast<const char*>(in_.data()) + at_, count);
  at_ += count;
}

}  // namespace slosh::wire
