#include "host/server/roster.h"

#include <gtest/gtest.h>

#include "net/clock.h"

namespace slosh {
namespace {

constexpr auto kHold = LinkRole::kHold;
constexpr auto kWatch = LinkRole::kWatch;

KeyFingerprint roster_key(std::uint32_t value) {
  KeyFingerprint fingerprint{};
  for (int i = 0; i < 4; ++i)
    fingerprint[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value >> (8 * i));
  return fingerprint;
}

SeatTable table(RosterLimits limits = {4, 10}) {
  return SeatTable({"left", "right"}, limits);
}

TEST(Roster, NamesAreNeverTheSame) {
  SeatTable seats = table();
  EXPECT_EQ(seats.arrive(roster_key(1), kHold, "Ana", "l").seat->name, "Ana");
  EXPECT_EQ(seats.arrive(roster_key(2), kHold, "Ana", "l").seat->name, "Ana 2");
  EXPECT_EQ(seats.arrive(roster_key(3), kWatch, "Ana", "l").seat->name, "Ana 3");
  EXPECT_EQ(seats.arrive(roster_key(4), kWatch, "", "l").seat->name, "guest 1");
  EXPECT_EQ(seats.arrive(roster_key(5), kWatch, "", "l").seat->name, "guest 2");
  const std::string longest(wire::kMaxName, 'x');
  EXPECT_EQ(seats.arrive(roster_key(6), kWatch, longest, "l").seat->name, longest);
  EXPECT_LE(seats.arrive(roster_key(7), kWatch, longest, "l").seat->name.size(), wire::kMaxName);
}

TEST(Roster, OneGripHasOneHolder) {
  SeatTable seats = table();
  Seat& ana = *seats.arrive(roster_key(1), kHold, "Ana", "l").seat;
  Seat& ben = *seats.arrive(roster_key(2), kHold, "Ben", "l").seat;
  Seat& eve = *seats.arrive(roster_key(3), kWatch, "Eve", "l").seat;
  EXPECT_TRUE(seats.take(ana, 0).granted);
  EXPECT_TRUE(seats.take(ana, 0).granted) << "asking twice does no harm";
  EXPECT_EQ(seats.take(ben, 0).text, "grip 'left' is held by Ana");
  EXPECT_TRUE(seats.take(ben, 1).granted);
  EXPECT_FALSE(seats.take(eve, 0).granted);
  EXPECT_NE(seats.take(eve, 0).text.find("watching"), std::string::npos);
  EXPECT_NE(seats.take(ben, 7).text.find("no grip '7'"), std::string::npos);
  EXPECT_NE(seats.release(ben, 0).text.find("do not hold"), std::string::npos);
  EXPECT_TRUE(seats.release(ana, 0).granted);
  EXPECT_TRUE(seats.take(ben, 0).granted);
  EXPECT_EQ(ben.grips, (std::vector<std::uint32_t>{0, 1}));
}

TEST(Roster, AMinuteAwayKeepsSeatAndGrips) {
  SeatTable seats = table();
  Seat& ana = *seats.arrive(roster_key(1), kHold, "Ana", "l").seat;
  Seat& ben = *seats.arrive(roster_key(2), kHold, "Ben", "l").seat;
  ASSERT_TRUE(seats.take(ana, 0).granted);
  const std::uint32_t number = ana.number;
  seats.lose(ana, 1000);
  EXPECT_NE(seats.take(ben, 0).text.find("is kept for Ana"), std::string::npos);
  EXPECT_TRUE(seats.expire(1000 + to_nanoseconds(kSeatKept)).empty());
  const SeatTable::Arrival back = seats.arrive(roster_key(1), kHold, "Other", "l");
  EXPECT_TRUE(back.restored);
  EXPECT_EQ(back.seat->number, number);
  EXPECT_EQ(back.seat->name, "Ana");
  EXPECT_EQ(back.seat->grips, (std::vector<std::uint32_t>{0}));
  EXPECT_TRUE(seats.expire(to_nanoseconds(1e6)).empty()) << "who is here stays";

  seats.lose(*back.seat, 2000);
  const std::vector<Seat> gone = seats.expire(2001 + to_nanoseconds(kSeatKept));
  ASSERT_EQ(gone.size(), 1u);
  EXPECT_EQ(gone[0].name, "Ana");
  EXPECT_TRUE(seats.take(ben, 0).granted);
  EXPECT_FALSE(seats.arrive(roster_key(1), kHold, "Ana", "l").restored);
}

TEST(Roster, WhoSaysGoodbyeLeavesTheGripToOthers) {
  SeatTable seats = table();
  Seat& ana = *seats.arrive(roster_key(1), kHold, "Ana", "l").seat;
  Seat& ben = *seats.arrive(roster_key(2), kHold, "Ben", "l").seat;
  ASSERT_TRUE(seats.take(ana, 0).granted);
  ASSERT_TRUE(seats.take(ana, 1).granted);
  seats.leave(ana, 1000);
  EXPECT_TRUE(seats.take(ben, 0).granted);
  const Seat& again = *seats.arrive(roster_key(1), kHold, {}, "l").seat;
  EXPECT_EQ(again.grips, (std::vector<std::uint32_t>{1})) << "what nobody took is still hers";
  EXPECT_EQ(seats.holder(0), &ben);
}

TEST(Roster, AnotherLinkMayChangeTheRole) {
  SeatTable seats = table();
  Seat& ana = *seats.arrive(roster_key(1), kHold, "Ana", "l").seat;
  ASSERT_TRUE(seats.take(ana, 0).granted);
  EXPECT_TRUE(seats.arrive(roster_key(1), kWatch, {}, "w").seat->grips.empty());
  EXPECT_EQ(seats.holder(0), nullptr);
}

TEST(Roster, ItFillsUpAndAbsentPeopleDoNotKeepOthersOut) {
  SeatTable seats = table({2, 3});
  EXPECT_NE(seats.arrive(roster_key(1), kHold, {}, "l").seat, nullptr);
  EXPECT_NE(seats.arrive(roster_key(2), kHold, {}, "l").seat, nullptr);
  const SeatTable::Arrival third = seats.arrive(roster_key(3), kHold, {}, "l");
  EXPECT_EQ(third.seat, nullptr);
  EXPECT_NE(third.text.find("full"), std::string::npos);
  for (std::uint32_t i = 100; i < 3000; ++i) {
    const SeatTable::Arrival arrival = seats.arrive(roster_key(i), kWatch, {}, "w");
    ASSERT_NE(arrival.seat, nullptr) << i;
    seats.lose(*arrival.seat, i);
  }
  EXPECT_LT(seats.seats().size(), 60u);
}

TEST(Roster, RecordsThatContradictThemselvesAreLeftOut) {
  SeatTable seats = table();
  seats.restore({{0, roster_key(1), "Ana", kHold, {0, 0, 9}, "l"},
                 {0, roster_key(2), "Ben", kHold, {}, "l"},
                 {1, roster_key(1), "Cem", kHold, {}, "l"},
                 {2, roster_key(3), "Ana", kHold, {}, "l"},
                 {3, roster_key(4), "Dan", kHold, {0, 1}, "l"},
                 {4, roster_key(5), "Eve", kWatch, {1}, "w"}},
                5);
  EXPECT_EQ(seats.seats().size(), 3u);
  EXPECT_EQ(seats.holder(0)->name, "Ana");
  EXPECT_EQ(seats.holder(1)->name, "Dan");
  EXPECT_FALSE(seats.holder(0)->connected);
  EXPECT_EQ(seats.records().size(), 3u);
}

}  // namespace
}  // namespace slosh
