// The kit finds what it is there to find: else a run without a finding says nothing.
#include <gtest/gtest.h>

#include "tests/hostile/mischief.h"
#include "tests/hostile/report.h"

namespace slosh::hostile {
namespace {

TEST(HostileKit, KnowsWhatMustNotReachATerminal) {
  for (const char* fit : {"", "Ana has left\n", "rtt 61 ms\r", "a\tb", "水 🪣 é × …"})
    EXPECT_EQ(unfit_for_a_terminal(fit), "") << fit;
  EXPECT_EQ(unfit_for_a_terminal("a\x1b[2J"), "U+001B at byte 1");
  EXPECT_EQ(unfit_for_a_terminal("\xc2\x9b"
                                 "31m"),
            "U+009B at byte 0");
  EXPECT_EQ(unfit_for_a_terminal("ab\x9b"), "byte 0x9b, no UTF-8, at byte 2");
  EXPECT_EQ(unfit_for_a_terminal("é\xc3"), "byte 0xc3, no UTF-8, at byte 2");
  for (const char* unfit :
       {"\x7f", "\b", "\xe2\x80\xae", "\xe2\x80\x8b", "\xef\xbb\xbf", "\xe2\x81\xa6", "\xff"})
    EXPECT_NE(unfit_for_a_terminal(unfit), "") << unfit;
  EXPECT_NE(unfit_for_a_terminal(std::string("a\0b", 3)), "");
}

TEST(HostileKit, KnowsHowAProgramShouldNotEnd) {
  const auto ended = [](int code, const std::string& err, long peak_kb = 1000) {
    return faults_of({code, "", err, peak_kb}, {0, 1});
  };
  EXPECT_TRUE(ended(0, "all is well\n").empty());
  EXPECT_TRUE(ended(1, "slosh: refused\n").empty());
  EXPECT_EQ(ended(134, "").size(), 1u) << "SIGABRT";
  EXPECT_EQ(ended(1, "a\n==7==ERROR: AddressSanitizer: heap-use-after-free on 0x1\nb").at(0),
            "==7==ERROR: AddressSanitizer: heap-use-after-free on 0x1");
  EXPECT_EQ(ended(0, "net/x.cpp:3:1: runtime error: shift exponent 64\n").size(), 1u);
  EXPECT_EQ(ended(0, "", 10'000'000).size(), 1u);
}

TEST(HostileKit, SendsTextsThatNoWriterWouldWrite) {
  Mischief mischief(1);
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    const wire::Bytes bytes = mischief.with_text(wire::Notice{}, &wire::Notice::text, wire::kMaxText);
    // Type and length, which takes one or two bytes.
    wire::Notice notice;
    const std::size_t head = bytes.size() - 2 < 0x80 ? 2 : 3;
    const wire::Fault fault = wire::decode(wire::ByteView(bytes).subspan(head), notice);
    refused += fault ? 1 : 0;
    if (fault) {
      EXPECT_EQ(fault.field, "text");
    }
  }
  EXPECT_GT(refused, 150);
}

TEST(HostileKit, SendsTheSameForTheSameSeed) {
  Mischief a(7);
  Mischief b(7);
  std::size_t valid = 0;
  for (int i = 0; i < 500; ++i) {
    const wire::Bytes bytes = a.datagram(wire::PeerDatagrams{});
    EXPECT_EQ(bytes, b.datagram(wire::PeerDatagrams{}));
    EXPECT_LE(bytes.size(), wire::kMaxDatagram);
    valid += wire::dispatch_datagram(wire::PeerDatagrams{}, bytes, [](const auto&) {}) ? 0 : 1;
  }
  EXPECT_GT(valid, 100u) << "what is valid gets furthest";
  EXPECT_LT(valid, 450u);
}

}  // namespace
}  // namespace slosh::hostile
