#include <gtest/gtest.h>

#include <random>

#include "net/wire/all_messages.h"
#include "net/wire/stream_splitter.h"
#include "tests/support/randomize.h"

namespace slosh::wire {
namespace {

struct Seen {
  std::uint64_t type = 0;
  Bytes payload;
  bool operator==(const Seen&) const = default;
};

/// A few of every kind, one after the other.
Bytes conversation(std::vector<Seen>& messages) {
  Bytes stream;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    for_each_message(HostControl{}, [&]<class M>(const M&) {
      const M message = random_message<M>(seed);
      const Bytes bytes = control(message);
      stream.insert(stream.end(), bytes.begin(), bytes.end());
      messages.push_back({static_cast<std::uint64_t>(M::kType), encoded(message)});
    });
  }
  return stream;
}

auto collect(std::vector<Seen>& seen) {
  return [&seen](std::uint64_t type, ByteView payload) {
    seen.push_back({type, Bytes(payload.begin(), payload.end())});
    return Fault{};
  };
}

TEST(StreamSplitter, GivesTheSameMessagesHoweverTheStreamIsCut) {
  std::vector<Seen> sent;
  const Bytes stream = conversation(sent);
  std::mt19937 random(1);
  for (const std::size_t longest :
       {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{300}, stream.size()}) {
    StreamSplitter splitter;
    std::vector<Seen> seen;
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t size = std::min(1 + random() % longest, stream.size() - at);
      ASSERT_FALSE(splitter.feed(ByteView(stream).subspan(at, size), collect(seen)));
      at += size;
    }
    EXPECT_EQ(seen, sent);
    EXPECT_EQ(splitter.held(), 0u);
    EXPECT_FALSE(splitter.finish());
  }
}

TEST(StreamSplitter, AnEndWithinAMessageIsAFault) {
  const Bytes bytes = control(Notice{"hello"});
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    StreamSplitter splitter;
    std::vector<Seen> seen;
    EXPECT_FALSE(splitter.feed(ByteView(bytes).first(size), collect(seen)));
    EXPECT_TRUE(seen.empty());
    EXPECT_EQ(static_cast<bool>(splitter.finish()), size > 0);
  }
}

TEST(StreamSplitter, RefusesBeforeItKeepsThePayload) {
  const struct {
    Bytes bytes;
    const char* words;
  } cases[] = {
      {{21, 0x81, 0x80, 0x08}, "length: 131073 is above 131072"},
      {{21, 0xff, 0xff, 0xff, 0xff, 0x0f}, "length: 4294967295 is above 131072"},
      {{0x80, 0x02, 0}, "type: 256 is above 255"},
      {{0x95, 0x00, 0}, "type: is a number written too long"},
      {{21, 0x80, 0x00}, "length: is a number written too long"},
      {{0xff, 0xff, 0xff, 0xff, 0xff, 0xff}, "type: ends too early"},
  };
  for (const auto& each : cases) {
    StreamSplitter splitter;
    std::vector<Seen> seen;
    Bytes bytes = each.bytes;
    bytes.resize(bytes.size() + 1000);
    EXPECT_EQ(splitter.feed(bytes, collect(seen)).text(), each.words);
    EXPECT_LE(splitter.held(), 6u);
    EXPECT_TRUE(seen.empty());
    EXPECT_TRUE(splitter.feed(control(Notice{"too late"}), collect(seen))) << "a fault stays";
    EXPECT_TRUE(seen.empty());
  }
}

TEST(StreamSplitter, AHandlersFaultStopsIt) {
  Bytes bytes = control(Notice{"one"});
  const Bytes second = control(Notice{"two"});
  bytes.insert(bytes.end(), second.begin(), second.end());
  StreamSplitter splitter;
  int seen = 0;
  const auto refuse = [&](std::uint64_t, ByteView) {
    ++seen;
    return Fault{"turn", "too early"};
  };
  EXPECT_EQ(splitter.feed(bytes, refuse).text(), "turn: too early");
  EXPECT_EQ(seen, 1);
}

TEST(StreamSplitter, TakesTheLargestAndTheEmptyMessage) {
  Bytes bytes;
  Writer writer(bytes);
  std::uint64_t type = 21, length = kMaxControlMessage;
  writer.natural("type", type, 0, 255);
  writer.natural("length", length, 0, kMaxControlMessage);
  bytes.resize(bytes.size() + kMaxControlMessage, 'x');
  bytes.push_back(7);
  bytes.push_back(0);
  StreamSplitter splitter;
  std::vector<Seen> seen;
  EXPECT_FALSE(splitter.feed(bytes, collect(seen)));
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].payload.size(), kMaxControlMessage);
  EXPECT_EQ(seen[1], (Seen{7, {}}));
}

}  // namespace
}  // namespace slosh::wire
