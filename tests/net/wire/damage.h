// What every list of fields must stand: round trips, cuts at every byte, every kind of damage.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/support/mutate.h"
#include "tests/support/randomize.h"

namespace slosh::test {

/// The fault names the field itself, or one within it (a list that is longer than its elements), or, where
/// the message was cut, a list around it.
inline bool names_field(const wire::Fault& fault, const wire::Damaged& damaged) {
  return fault.field == damaged.field || fault.field.starts_with(damaged.field + ".") ||
         (damaged.cut && damaged.field.starts_with(fault.field + "."));
}

/// Encodes, decodes, encodes: the same bytes, and nothing brought into range.
template <class M>
void expect_round_trip(const M& message) {
  wire::Bytes bytes;
  const wire::Fault altered = wire::encode(message, bytes);
  ASSERT_FALSE(altered) << altered.text();
  M back{};
  const wire::Fault fault = wire::decode(bytes, back);
  ASSERT_FALSE(fault) << fault.text();
  ASSERT_EQ(wire::encoded(back), bytes);
}

/// Every beginning of the message is refused, and one byte more.
template <class M>
void expect_cuts_refused(const M& message) {
  const wire::Bytes whole = wire::encoded(message);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    M back{};
    const wire::Fault fault = wire::decode(wire::ByteView(whole).first(size), back);
    ASSERT_TRUE(fault) << "cut to " << size << " of " << whole.size() << " bytes";
    EXPECT_FALSE(fault.field.empty());
    EXPECT_EQ(fault.problem, "ends too early") << fault.field;
  }
  wire::Bytes longer = whole;
  longer.push_back(0);
  M back{};
  EXPECT_EQ(wire::decode(longer, back).text(), "end: 1 bytes follow");
}

/// Every damage is refused with a fault that names the field. Returns how many there were.
template <class M>
std::size_t expect_damages_refused(const M& message) {
  for (std::size_t which = 0;; ++which) {
    const wire::Damaged damaged = wire::damaged_message(message, which);
    if (damaged.field.empty()) {
      EXPECT_EQ(damaged.bytes, wire::encoded(message)) << "without damage a Mutator writes as a Writer does";
      return which;
    }
    M back{};
    const wire::Fault fault = wire::decode(damaged.bytes, back);
    EXPECT_TRUE(fault) << damaged.field << ": " << damaged.damage;
    EXPECT_TRUE(names_field(fault, damaged))
        << damaged.field << ", " << damaged.damage << " was refused as " << fault.text();
  }
}

}  // namespace slosh::test
