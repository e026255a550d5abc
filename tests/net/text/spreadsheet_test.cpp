// A stranger's names in a table: no spreadsheet runs them, and a reader has them back.
#include "net/text/spreadsheet.h"

#include <gtest/gtest.h>

#include <vector>

namespace slosh {
namespace {

TEST(SpreadsheetText, NoNameIsAFormula) {
  for (const char* name : {"=1+1", "+1", "-2+3", "@SUM(1)", "=cmd|' /C calc'!A0", "=", "-", "\uff1d1+1",
                           "\uff0b1", "\uff0d1", "\uff20SUM(1)"}) {
    EXPECT_EQ(as_spreadsheet_text(name), std::string("'") + name);
  }
  EXPECT_EQ(as_spreadsheet_text("a;=1+1"), "a;'=1+1") << "where a semicolon divides cells";
  EXPECT_EQ(as_spreadsheet_text("a,@b\n-c"), "a,'@b\n'-c");
  EXPECT_EQ(as_spreadsheet_text("\t=1"), "'\t'=1");
  EXPECT_EQ(as_spreadsheet_text("\r=1"), "'\r'=1");
  for (const char* name : {"", "bucket", "left hand", "a=b", "1-2", "'", "''", "it's", "'quoted'", "a; b",
                           "a, b", ";", "\u4e00"}) {
    EXPECT_EQ(as_spreadsheet_text(name), name) << "is no formula";
  }
}

TEST(SpreadsheetText, AReaderHasEveryNameBack) {
  // Every text of up to five of what matters.
  const char* const pieces[] = {"'", "=", "-", ";", ",", "\t", "\r", "\n", "a", "\uff20", "\uff1c"};
  std::vector<std::string> texts{""};
  for (std::size_t begin = 0, length = 0; length < 5; ++length) {
    const std::size_t end = texts.size();
    for (std::size_t i = begin; i < end; ++i) {
      for (const char* piece : pieces) texts.push_back(texts[i] + piece);
    }
    begin = end;
  }
  std::size_t wrong = 0;
  for (const std::string& text : texts) wrong += from_spreadsheet_text(as_spreadsheet_text(text)) != text;
  EXPECT_EQ(wrong, 0u) << "of " << texts.size();
}

}  // namespace
}  // namespace slosh
