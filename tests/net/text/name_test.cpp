#include "net/text/name.h"

#include <gtest/gtest.h>

#include <random>

#include "net/text/clean.h"

namespace slosh {
namespace {

TEST(CleanName, WhatPeopleAreCalledStays) {
  for (const char* name : {"Ana", "Zoë", "Søren K.", "O'Brien", "Anne-Marie", "李小龍", "Мария", "Χρήστος",
                           "محمد", "नरेंद्र", "guest 2", "ana_7", "Ana 🐙", "Will Smith", "Zoe2"}) {
    EXPECT_EQ(clean_name(name), name);
  }
}

TEST(CleanName, OneSpaceBetweenWordsAndNoneAround) {
  EXPECT_EQ(clean_name("  Ana \u00a0\u3000 Maria\u2003"), "Ana Maria");
  for (const char* nothing : {"", " ", "\u00a0\u2003", "\u200b\u200d", "\u2800\u2800", "\u3164", "...", "-",
                              "::", "\u0301", "\x1b", "│ │"}) {
    EXPECT_EQ(clean_name(nothing), "") << nothing;
  }
}

TEST(CleanName, WhatIsShownCanBeTyped) {
  EXPECT_EQ(clean_name("Ａｎａ"), "Ana") << "full width";
  EXPECT_EQ(clean_name("𝓐𝓷𝓪"), "Ana") << "mathematical";
  EXPECT_EQ(clean_name("Zoe\u0308"), "Zoë") << "composed, as a keyboard does it";
  EXPECT_EQ(clean_name("Anne\u2011Marie"), "Anne-Marie");
  EXPECT_EQ(clean_name("O\u2019Brien"), "O'Brien");
  EXPECT_EQ(clean_name("A\"n'a\\: ;b"), "A n'a b");
}

TEST(CleanName, ReadsLikeNoNotice) {
  for (const char* notice :
       {"Ana has left", "Ana HAS LEFT", "Ana is here", "Ana  is\u00a0back", "Ana was put out", "Ana (left)",
        "Ana did not come back", "Ana paused the world", "Ana lets the world go on", "Ana h\u0430s left",
        "Ana ｈａｓ left", "Ana has\u200b left", "Ana h\u200bas left", "Ana\nhas left", "Ana i\u0455 back"}) {
    EXPECT_EQ(clean_name(notice), "Ana") << notice;
  }
  EXPECT_EQ(clean_name("has left"), "");
}

TEST(CleanName, IsCutAtItsLength) {
  EXPECT_EQ(clean_name(std::string(5000, 'a')), std::string(32, 'a'));
  EXPECT_EQ(clean_name("水水水水水水水水水水水水"), "水水水水水水水水水水") << "30 bytes: between characters";
  EXPECT_EQ(clean_name(std::string(29, 'a') + " hasty"), std::string(29, 'a') + " ha");
  EXPECT_EQ(clean_name(std::string(28, 'a') + " hasty"), std::string(28, 'a'))
      << "cut to 'has' it would read so";
}

TEST(CleanName, ACleanedNameComesBackAsItIs) {
  std::mt19937_64 random(1121);
  const char* const pieces[] = {"Ana",    " ",  "has",    "left",   "-", "'", ".",      "\u0301",
                                "\u200b", "水", "\x80",   "🐙",     "İ", "ﷺ", "\u2800", "i",
                                "s",      "1",  "\u1ea0", "\u2126", "½", "ǅ", "\u3000"};
  for (int i = 0; i < 20'000; ++i) {
    std::string foreign;
    for (std::size_t n = random() % 20; n > 0; --n) foreign += pieces[random() % std::size(pieces)];
    const std::string name = clean_name(foreign);
    ASSERT_LE(name.size(), kMaxNameBytes);
    ASSERT_EQ(text_problem(name), "") << foreign;
    ASSERT_EQ(clean_name(name), name) << foreign;
    ASSERT_EQ(name.empty(), name_skeleton(name).empty());
  }
}

TEST(NameSkeleton, NamesThatLookAlikeHaveTheSame) {
  const auto same = [](const char* a, const char* b) {
    EXPECT_EQ(name_skeleton(a), name_skeleton(b)) << a << " " << b;
  };
  same("Ana", "An\u0430");  // Cyrillic
  same("Ana", "\u0410n\u0430");
  same("ANA", "\u0391\u039d\u0391");  // Greek
  same("Ana", "Ａｎａ");
  same("Ana", "ana");
  same("Ana", "An\u200ba");
  same("Ana", "A n a");
  same("Ana", "Ana.");
  same("Ana", "An\u1ea1");  // a dot below
  same("Ian", "lan");
  same("Ian", "1an");
  same("Ian", "ian");
  same("Bob", "B0b");
  same("Max", "M\u0430x");
  same("Zoë", "Zoe\u0308");
  same("Paypal", "P\u0430yp\u0430l");
  same("modern", "rnodern");
}

TEST(NameSkeleton, OtherNamesHaveAnother) {
  const char* const names[] = {"Ana", "Anna",  "Ben",     "Bea", "guest 1", "guest 2", "guest 12", "水",
                               "火",  "Мария", "Χρήστος", "🐙",  "🦑",      "कु",       "का",       "Zoe 2"};
  for (const char* a : names) {
    for (const char* b : names) {
      if (a != b) {
        EXPECT_NE(name_skeleton(a), name_skeleton(b)) << a << " " << b;
      }
    }
  }
}

TEST(NameSkeleton, IsEmptyForNothingElse) {
  EXPECT_EQ(name_skeleton(""), "");
  for (const char* name : {"...", "- -", "'"}) EXPECT_NE(name_skeleton(name), "") << name;
}

}  // namespace
}  // namespace slosh
