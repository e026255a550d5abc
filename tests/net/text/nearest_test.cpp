#include "net/text/nearest.h"

#include <gtest/gtest.h>

namespace slosh {
namespace {

TEST(NearestWord, IsTheOneThatWasMeant) {
  const std::vector<std::string> known{"font_scale", "spacing", "device", "record"};
  EXPECT_EQ(nearest_word("fontscale", known), "font_scale");
  EXPECT_EQ(nearest_word("Spacing", known), "spacing");
  EXPECT_EQ(nearest_word("font-scale", known), "font_scale");
  EXPECT_EQ(nearest_word("dveice", known), "device");
  EXPECT_EQ(nearest_word("gravity", known), "");
  EXPECT_EQ(nearest_word("", known), "");
  EXPECT_EQ(nearest_word("on", {"who"}), "") << "nothing of it is left";
  EXPECT_EQ(nearest_word("yes", {"set"}), "") << "another word";
  EXPECT_EQ(nearest_word("plya", {"play"}), "play");
  EXPECT_EQ(did_you_mean("Spacng", known), "Did you mean spacing? ");
  EXPECT_EQ(did_you_mean("gravity", known), "");
  EXPECT_EQ(nearest_word(std::string(1'000'000, 'x'), known), "");
}

}  // namespace
}  // namespace slosh
