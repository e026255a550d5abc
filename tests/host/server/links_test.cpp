#include "host/server/links.h"

#include <gtest/gtest.h>

#include <set>

#include "host/server/server_state.h"

namespace slosh {
namespace {

constexpr std::int64_t kNow = 1'700'000'000'000'000'000;
constexpr std::int64_t kMinute = 60'000'000'000;

KeyFingerprint link_key(std::uint8_t value) {
  KeyFingerprint fingerprint{};
  fingerprint.fill(value);
  return fingerprint;
}

TEST(Links, AnOpenLinkAdmitsAnybody) {
  LinkRegistry links;
  const LinkRecord link = *links.create(LinkRole::kWatch, {}, kNow);
  for (std::uint8_t i = 1; i < 100; ++i) {
    const LinkVerdict verdict = links.check(link.token, link_key(i), kNow);
    ASSERT_NE(verdict.link, nullptr);
    EXPECT_EQ(verdict.link->role, LinkRole::kWatch);
    links.note_use(link.id, link_key(i));
  }
}

TEST(Links, APersonalLinkBelongsToTheFirstKey) {
  LinkRegistry links;
  const LinkRecord link = *links.create(LinkRole::kHold, "Ana", kNow);
  ASSERT_NE(links.check(link.token, link_key(1), kNow).link, nullptr);
  links.note_use(link.id, link_key(1));
  EXPECT_NE(links.check(link.token, link_key(1), kNow).link, nullptr);
  const LinkVerdict other = links.check(link.token, link_key(2), kNow);
  EXPECT_EQ(other.link, nullptr);
  EXPECT_EQ(other.code, wire::RefusalCode::kBadToken);
  EXPECT_NE(other.text.find("one person"), std::string::npos);
}

TEST(Links, EveryWrongTokenIsRefused) {
  LinkRegistry links;
  const LinkRecord link = *links.create(LinkRole::kHold, {}, kNow);
  for (std::size_t byte = 0; byte < link.token.size(); ++byte) {
    wire::Token wrong = link.token;
    wrong[byte] ^= 1;
    EXPECT_EQ(links.check(wrong, link_key(1), kNow).link, nullptr);
  }
  EXPECT_EQ(links.check({}, link_key(1), kNow).code, wire::RefusalCode::kBadToken);
}

TEST(Links, OnlyWhoWasInLearnsThatALinkWasRevokedOrHasExpired) {
  LinkRegistry links;
  const LinkRecord link = *links.create(LinkRole::kHold, {}, kNow, kMinute);
  links.note_use(link.id, link_key(1));
  EXPECT_NE(links.check(link.token, link_key(1), kNow + kMinute - 1).link, nullptr);
  EXPECT_EQ(links.check(link.token, link_key(1), kNow + kMinute).code, wire::RefusalCode::kExpired);
  EXPECT_EQ(links.check(link.token, link_key(2), kNow + kMinute).code, wire::RefusalCode::kBadToken);
  EXPECT_TRUE(links.set_expiry(link.id, 0));
  EXPECT_NE(links.check(link.token, link_key(2), kNow + 100 * kMinute).link, nullptr);
  EXPECT_TRUE(links.revoke(link.id));
  EXPECT_EQ(links.check(link.token, link_key(1), kNow).code, wire::RefusalCode::kRevoked);
  EXPECT_EQ(links.check(link.token, link_key(2), kNow).code, wire::RefusalCode::kBadToken);
  EXPECT_FALSE(links.revoke("nosuch"));
  EXPECT_FALSE(links.set_expiry("nosuch", 0));
}

TEST(Links, IdsAndTokensDifferAndRoomIsBounded) {
  LinkRegistry links;
  std::set<std::string> ids;
  std::set<wire::Token> tokens;
  for (std::size_t i = 0; i < kMaxLinks; ++i) {
    const LinkRecord* link = links.create(LinkRole::kWatch, {}, kNow);
    ASSERT_NE(link, nullptr);
    EXPECT_EQ(link->id.size(), 4u);
    ids.insert(link->id);
    tokens.insert(link->token);
  }
  EXPECT_EQ(ids.size(), kMaxLinks);
  EXPECT_EQ(tokens.size(), kMaxLinks);
  EXPECT_EQ(links.create(LinkRole::kWatch, {}, kNow), nullptr);
  links.revoke(*ids.begin());
  EXPECT_NE(links.create(LinkRole::kWatch, {}, kNow), nullptr) << "a revoked one makes room";
}

TEST(Links, TheServersStateComesBackAsItWas) {
  ServerState state;
  state.private_key = {1, 2, 3};
  state.world = 0x1234567890abcdef;
  state.port = 4433;
  LinkRegistry links;
  const LinkRecord made = *links.create(LinkRole::kHold, "Ana", kNow, kMinute);
  links.note_use(made.id, link_key(9));
  state.links = links.links();
  state.seats.push_back({3, link_key(9), "Ana", LinkRole::kHold, {0, 2}, made.id});

  const wire::Bytes bytes = wire::encoded(state);
  ServerState back;
  const wire::Fault fault = wire::decode(bytes, back);
  ASSERT_FALSE(fault) << fault.text();
  EXPECT_EQ(wire::encoded(back), bytes);
  LinkRegistry again;
  again.restore(back.links);
  EXPECT_NE(again.check(made.token, link_key(9), kNow).link, nullptr);
  EXPECT_EQ(again.check(made.token, link_key(8), kNow).link, nullptr);
  EXPECT_EQ(back.seats[0].grips, (std::vector<std::uint32_t>{0, 2}));
  for (std::size_t cut = 0; cut < bytes.size(); ++cut)
    EXPECT_TRUE(wire::decode(wire::ByteView(bytes).first(cut), back));
}

}  // namespace
}  // namespace slosh
