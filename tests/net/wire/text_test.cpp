#include "net/wire/text.h"

#include <gtest/gtest.h>

namespace slosh::wire {
namespace {

TEST(Text, WhatPeopleWriteIsFine) {
  for (const char* text : {"", "Ada", "Zoë", "水の桶", "🪣 bucket", "tab-less, 50 %", "\u00a0"})
    EXPECT_EQ(text_problem(text), "") << text;
}

TEST(Text, SaysWhereAndWhat) {
  EXPECT_EQ(text_problem("ab\xff"), "is not UTF-8 at byte 2");
  EXPECT_EQ(text_problem("é\x1b[2J"), "has a control character at byte 2");
  EXPECT_EQ(text_problem("\u202eevil"), "has a control character at byte 0");
  EXPECT_EQ(text_problem("a\u2066b"), "has a control character at byte 1");
  EXPECT_EQ(text_problem(std::string_view("a\0b", 3)), "has a control character at byte 1");
}

TEST(Text, EveryPairOfBytesIsCleanedToSomethingFine) {
  for (int a = 0; a < 256; ++a) {
    for (int b = 0; b < 256; ++b) {
      for (const char* tail : {"", "\x80", "\x80\x80"}) {
        const std::string text = std::string{static_cast<char>(a), static_cast<char>(b)} + tail;
        const std::string clean = clean_text(text, 100);
        ASSERT_EQ(text_problem(clean), "");
        if (text_problem(text).empty()) {
          ASSERT_EQ(clean, text);
        } else {
          ASSERT_NE(clean, text);
        }
      }
    }
  }
}

TEST(Text, IsCutBetweenCharacters) {
  EXPECT_EQ(clean_text("水水", 5), "水");
  EXPECT_EQ(clean_text("水水", 2), "");
  EXPECT_EQ(clean_text("abc", 2), "ab");
  EXPECT_EQ(clean_text("a\nb\x80", 9), "a?b?");
}

}  // namespace
}  // namespace slosh::wire
