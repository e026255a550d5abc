#include "peer/output/line_input.h"

#include <gtest/gtest.h>

namespace slosh {
namespace {

using Lines = std::vector<std::string>;

TEST(LineEditor, KeysBecomeLines) {
  LineEditor editor;
  editor.feed("set gra");
  EXPECT_EQ(editor.text(), "set gra");
  EXPECT_TRUE(editor.take_lines().empty());
  editor.feed("vity 1\nwho\rhe");
  EXPECT_EQ(editor.take_lines(), (Lines{"set gravity 1", "who"}));
  EXPECT_EQ(editor.text(), "he");
  EXPECT_TRUE(editor.take_lines().empty());
}

TEST(LineEditor, BackspaceTakesACharacterHoweverManyBytesItHas) {
  LineEditor editor;
  editor.feed("Zoë\x7f");
  EXPECT_EQ(editor.text(), "Zo");
  editor.feed("\x7f\x7f\x7f\b");
  EXPECT_EQ(editor.text(), "");
  editor.feed("kick Ana Maria \x17");
  EXPECT_EQ(editor.text(), "kick Ana ");
  editor.feed("\x15");
  EXPECT_EQ(editor.text(), "");
}

TEST(LineEditor, ArrowsAndOtherKeysDoNothing) {
  LineEditor editor;
  editor.feed("a\x1b[Ab\x1b[1;5Cc\x1bOPd\x1b");
  editor.feed("[3~e\x01\x04\tf");
  EXPECT_EQ(editor.text(), "abcde f");
}

TEST(LineEditor, ALineIsBounded) {
  LineEditor editor;
  editor.feed(std::string(10 * kMaxConsoleLine, 'x'));
  EXPECT_EQ(editor.text().size(), kMaxConsoleLine);
}

}  // namespace
}  // namespace slosh
