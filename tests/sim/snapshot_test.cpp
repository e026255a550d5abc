#include "sim/snapshot.h"

#include <gtest/gtest.h>

namespace slosh {
namespace {

TEST(StatusText, SaysEveryBitInWords) {
  EXPECT_EQ(status_text(0), "");
  for (std::uint32_t bit = 1; bit <= kStatusBodyGone; bit <<= 1)
    EXPECT_FALSE(status_text(bit).empty()) << bit;
  const std::string both = status_text(kStatusEscaped | kStatusTimeSlipped);
  EXPECT_NE(both.find("left the domain"), std::string::npos);
  EXPECT_NE(status_text(kStatusCompressed).find("100 to 400"), std::string::npos)
      << "what tests/notebook/2026-11-27-penetration-clamp.md measured";
  EXPECT_NE(both.find("; "), std::string::npos);
}

}  // namespace
}  // namespace slosh
