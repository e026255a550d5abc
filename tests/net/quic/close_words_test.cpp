// What the other side of a connection says when it closes reaches a terminal here.
#include "net/quic/close_words.h"

#include <gtest/gtest.h>

#include "net/text/clean.h"

namespace slosh::quic {
namespace {

TEST(CloseWords, TellATerminalNothing) {
  for (const std::string reason : {"\x1b[2J\x1b]0;owned\x07", "\u009b2J", "\x9b[2J", "line\nline\rline",
                                   "\u202eevil\u2066", "\xff\xfe\x80"}) {
    const std::string shown = printable(reason);
    EXPECT_EQ(text_problem(shown), "") << shown;
    CloseFrame frame;
    frame.text = reason;
    for (const std::uint64_t code : {std::uint64_t{NGTCP2_CONNECTION_REFUSED}, std::uint64_t{7}}) {
      frame.code = code;
      for (const bool to_server : {true, false})
        EXPECT_EQ(text_problem(transport_words(frame, to_server)), "") << transport_words(frame, to_server);
    }
  }
  EXPECT_EQ(printable("the host has ended the run"), "the host has ended the run");
  EXPECT_LE(printable(std::string(100'000, 'x')).size(), kMaxTextBytes);
}

}  // namespace
}  // namespace slosh::quic
