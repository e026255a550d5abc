#include "net/text/clean.h"

#include <gtest/gtest.h>

#include <random>

namespace slosh {
namespace {

/// Independent of the code under test: nothing in it but UTF-8 without C0, DEL and C1.
bool could_write_to_a_terminal(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20 || byte == 0x7f) return true;
    if (byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0) return true;
  }
  return false;
}

TEST(CleanText, WhatPeopleWriteIsFine) {
  for (const char* text : {"", "Ada", "Zoë", "Zoe\u0308", "水の桶", "🪣 bucket", "tab-less, 50 %", "\u00a0",
                           "Việt", "नमस्ते", "שָׁלוֹם", "ก้อ", "👍🏽", "a\u0301\u0302\u0303"}) {
    EXPECT_EQ(text_problem(text), "") << text;
    EXPECT_EQ(clean_text(text, 1000), text);
  }
}

TEST(CleanText, SaysWhereAndWhat) {
  EXPECT_EQ(text_problem("ab\xff"), "is not UTF-8 at byte 2");
  EXPECT_EQ(text_problem("é\x1b[2J"), "has a control character at byte 2");
  EXPECT_EQ(text_problem("\u009b2J"), "has a control character at byte 0");
  EXPECT_EQ(text_problem("\u202eevil"), "has an invisible character at byte 0");
  EXPECT_EQ(text_problem("a\u2066b"), "has an invisible character at byte 1");
  EXPECT_EQ(text_problem(std::string_view("a\0b", 3)), "has a control character at byte 1");
  EXPECT_EQ(text_problem("\u0301a"), "has a mark on nothing at byte 0");
  EXPECT_EQ(text_problem("a\u0301\u0301\u0301\u0301"), "has too many marks on a character at byte 7");
}

TEST(CleanText, NothingThatATerminalObeysIsLeft) {
  EXPECT_EQ(clean_text("\x1b[2J\x1b]0;title\x07", 100), "?[2J?]0;title?");
  EXPECT_EQ(clean_text("\u009b31mred", 100), "?31mred") << "CSI as one C1 character";
  EXPECT_EQ(clean_text("\x9b"
                       "31mred",
                       100),
            "?31mred")
      << "and as a raw byte, which terminals of eight bits obey";
  EXPECT_EQ(clean_text("two\nlines\r", 100), "two?lines?");
  EXPECT_EQ(clean_text("a\u2028b\u2029c", 100), "a?b?c");
  EXPECT_EQ(clean_text("\xed\xa0\x80\xc0\x80", 100), "?????") << "a surrogate and an overlong zero";
}

TEST(CleanText, WhatShowsNothingIsLeftOut) {
  for (const char* unseen :
       {"\u200b", "\u200c",     "\u200d",     "\u2060",     "\ufeff", "\u00ad", "\u180e", "\u115f",
        "\u3164", "\uffa0",     "\u202a",     "\u202e",     "\u2066", "\u2069", "\u061c", "\u200e",
        "\ufe0f", "\U000e0100", "\U000e0041", "\U000e0001", "\u034f", "\u17b4"}) {
    EXPECT_EQ(clean_text(std::string("A") + unseen + "na", 100), "Ana") << unseen;
    EXPECT_NE(text_problem(std::string("A") + unseen + "na"), "") << unseen;
  }
}

TEST(CleanText, WhatNobodyCanKnowHowToShowIsReplaced) {
  EXPECT_EQ(clean_text("a\ue000b", 100), "a?b") << "private use";
  EXPECT_EQ(clean_text("a\ufdd0b\uffff", 100), "a?b?") << "no characters";
  EXPECT_EQ(clean_text("a\U0003fffdb", 100), "a?b") << "not assigned";
  EXPECT_EQ(text_problem("a\U0003fffdb"), "") << "another machine's Unicode may know it";
}

TEST(CleanText, MarksDoNotPileUp) {
  std::string pile = "a";
  for (int i = 0; i < 40; ++i) pile += "\u0353";
  EXPECT_EQ(clean_text(pile, 1000), "a\u0353\u0353\u0353");
  EXPECT_EQ(clean_text("\u0301\u0301" + pile, 1000), "a\u0353\u0353\u0353");
  EXPECT_EQ(clean_text("a\u0353\u0353\u200b\u0353\u0353", 100), "a\u0353\u0353\u0353")
      << "nor around what is left out";
}

TEST(CleanText, IsCutBetweenCharacters) {
  EXPECT_EQ(clean_text("水水", 5), "水");
  EXPECT_EQ(clean_text("水水", 2), "");
  EXPECT_EQ(clean_text("abc", 2), "ab");
  EXPECT_EQ(clean_text("a\nb\x80", 9), "a?b?");
  EXPECT_LT(clean_text(std::string(10'000'000, '\x80'), 50).size(), 51u);
}

TEST(CleanText, LinesStayLines) {
  EXPECT_EQ(clean_lines("a\nb\x1b\n\n\u200bc\n", 100), "a\nb?\n\nc\n");
  EXPECT_EQ(clean_lines("aa\nbb\ncc", 5), "aa\nbb");
  EXPECT_EQ(clean_lines("", 5), "");
}

TEST(CleanText, EveryPairOfBytesIsCleanedToSomethingFine) {
  for (int a = 0; a < 256; ++a) {
    for (int b = 0; b < 256; ++b) {
      for (const char* tail : {"", "\x80", "\x80\x80"}) {
        const std::string text = std::string{static_cast<char>(a), static_cast<char>(b)} + tail;
        const std::string clean = clean_text(text, 100);
        ASSERT_EQ(text_problem(clean), "");
        if (clean == text) {
          ASSERT_EQ(text_problem(text), "");
        } else if (text_problem(text).empty()) {
          ASSERT_NE(clean.find('?'), std::string::npos) << "only what is not assigned yet";
        }
      }
    }
  }
}

TEST(CleanText, EveryCodePointIsCleanedToSomethingFine) {
  for (std::uint32_t code = 0; code <= 0x10ffff; ++code) {
    std::string text = "a";
    if (code < 0x80) {
      text += static_cast<char>(code);
    } else if (code < 0x800) {
      text += static_cast<char>(0xc0 | code >> 6);
      text += static_cast<char>(0x80 | (code & 0x3f));
    } else if (code < 0x10000) {
      text += static_cast<char>(0xe0 | code >> 12);
      text += static_cast<char>(0x80 | (code >> 6 & 0x3f));
      text += static_cast<char>(0x80 | (code & 0x3f));
    } else {
      text += static_cast<char>(0xf0 | code >> 18);
      text += static_cast<char>(0x80 | (code >> 12 & 0x3f));
      text += static_cast<char>(0x80 | (code >> 6 & 0x3f));
      text += static_cast<char>(0x80 | (code & 0x3f));
    }
    const std::string clean = clean_text(text, 100);
    ASSERT_EQ(text_problem(clean), "") << std::hex << code;
    ASSERT_FALSE(could_write_to_a_terminal(clean)) << std::hex << code;
    if (!text_problem(text).empty()) {
      ASSERT_NE(clean, text) << std::hex << code;
    }
    ASSERT_EQ(clean_text(clean, 100), clean) << std::hex << code;
  }
}

TEST(CleanText, RandomBytesComeOutFineAndStaySo) {
  std::mt19937_64 random(20261121);
  for (int i = 0; i < 200'000; ++i) {
    std::string text(random() % 40, '\0');
    // Half of it from bytes that make long sequences, marks and what is left out.
    constexpr unsigned char kLikely[] = {0xcc, 0x81, 0xe2, 0x80, 0x8b, 0xf3,
                                         0xa0, 0x84, 0xc2, 0x9b, 0x1b, 'a'};
    for (char& c : text)
      c = static_cast<char>(random() % 2 == 0 ? kLikely[random() % sizeof kLikely] : random() & 0xff);
    const std::size_t most = random() % 50;
    const std::string clean = clean_text(text, most);
    ASSERT_LE(clean.size(), most);
    ASSERT_EQ(text_problem(clean), "");
    ASSERT_FALSE(could_write_to_a_terminal(clean));
    ASSERT_EQ(clean_text(clean, most), clean);
  }
}

}  // namespace
}  // namespace slosh
