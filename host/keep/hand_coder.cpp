#include "host/keep/hand_coder.h"

#include <bit>

namespace slosh::keep {
namespace {

constexpr std::uint16_t kEngaged = 1u << 14;
constexpr std::uint16_t kUnused = 1u << 15;

std::uint64_t zigzag(std::uint64_t difference) {
  const auto value = static_cast<std::int64_t>(difference);
  return (difference << 1) ^ static_cast<std::uint64_t>(value >> 63);
}
std::uint64_t unzigzag(std::uint64_t coded) {
  return (coded >> 1) ^ (~(coded & 1) + 1);
}
int bytes_of(std::uint64_t value) {
  return (std::bit_width(value) + 7) / 8;
}

bool take(ByteView& in, std::size_t count, std::uint64_t& value) {
  if (in.size() < count) return false;
  value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::uint64_t{in[i]} << (8 * i);
  in = in.subspan(count);
  return true;
}

}  // namespace

HandCoder::Words HandCoder::Track::expected() const {
  Words words;
  for (std::size_t i = 0; i < kWords; ++i) words[i] = 2 * last[i] - before[i];
  return words;
}

void HandCoder::Track::take(const Words& words, bool is_engaged) {
  before = last;
  last = words;
  engaged = is_engaged;
}

HandCoder::Words HandCoder::words_of(const HandleInput& hand) {
  const Pose& p = hand.pose;
  const Twist& t = hand.twist;
  const double values[kWords] = {p.position.x,    p.position.y,    p.position.z,    p.orientation.w,
                                 p.orientation.x, p.orientation.y, p.orientation.z, t.linear.x,
                                 t.linear.y,      t.linear.z,      t.angular.x,     t.angular.y,
                                 t.angular.z,     hand.scale};
  Words words;
  for (std::size_t i = 0; i < kWords; ++i) words[i] = std::bit_cast<std::uint64_t>(values[i]);
  return words;
}

HandleInput HandCoder::hand_of(const Words& words, bool engaged) {
  double v[kWords];
  for (std::size_t i = 0; i < kWords; ++i) v[i] = std::bit_cast<double>(words[i]);
  HandleInput hand;
  hand.pose.position = {v[0], v[1], v[2]};
  hand.pose.orientation = glm::dquat(v[3], v[4], v[5], v[6]);
  hand.twist = {{v[7], v[8], v[9]}, {v[10], v[11], v[12]}};
  hand.scale = v[13];
  hand.engaged = engaged;
  return hand;
}

bool HandCoder::encode(std::span<const HandleInput> hands, Bytes& out) {
  const std::size_t begin = out.size();
  bool news = false;
  for (std::size_t h = 0; h < tracks_.size(); ++h) {
    Track& track = tracks_[h];
    const HandleInput hand = h < hands.size() && hands[h].engaged ? hands[h] : HandleInput{};
    const Words words = words_of(hand);
    const Words guess = track.expected();
    std::uint16_t mask = hand.engaged ? kEngaged : 0;
    std::array<std::uint64_t, kWords> off;
    std::array<std::uint8_t, kWords> lengths;
    std::size_t count = 0;
    for (std::size_t i = 0; i < kWords; ++i) {
      if (words[i] == guess[i]) continue;
      mask = static_cast<std::uint16_t>(mask | 1u << i);
      off[count] = zigzag(words[i] - guess[i]);
      lengths[count] = static_cast<std::uint8_t>(bytes_of(off[count]));
      count += 1;
    }
    news |= count > 0 || hand.engaged != track.engaged;
    track.take(words, hand.engaged);
    out.push_back(static_cast<std::uint8_t>(mask));
    out.push_back(static_cast<std::uint8_t>(mask >> 8));
    for (std::size_t i = 0; i < count; i += 2) {
      const unsigned second = i + 1 < count ? lengths[i + 1] : 0u;
      out.push_back(static_cast<std::uint8_t>(lengths[i] | second << 4));
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (int b = 0; b < lengths[i]; ++b) out.push_back(static_cast<std::uint8_t>(off[i] >> (8 * b)));
    }
  }
  if (!news) out.resize(begin);
  return news;
}

bool HandCoder::decode(ByteView& in, std::vector<HandleInput>& hands) {
  hands.resize(tracks_.size());
  for (std::size_t h = 0; h < tracks_.size(); ++h) {
    Track& track = tracks_[h];
    std::uint64_t mask = 0;
    if (!take(in, 2, mask) || (mask & kUnused)) return false;
    std::array<std::uint8_t, kWords + 1> lengths{};
    const int count = std::popcount(mask & (kEngaged - 1u));
    for (int i = 0; i < count; i += 2) {
      std::uint64_t pair = 0;
      if (!take(in, 1, pair)) return false;
      lengths[static_cast<std::size_t>(i)] = pair & 15;
      lengths[static_cast<std::size_t>(i) + 1] = static_cast<std::uint8_t>(pair >> 4);
    }
    Words words = track.expected();
    std::size_t next = 0;
    for (std::size_t i = 0; i < kWords; ++i) {
      if (!(mask & 1u << i)) continue;
      std::uint64_t off = 0;
      const std::size_t length = lengths[next++];
      if (length == 0 || length > 8 || !take(in, length, off)) return false;
      words[i] += unzigzag(off);
    }
    track.take(words, (mask & kEngaged) != 0);
    hands[h] = hand_of(words, track.engaged);
  }
  return true;
}

void HandCoder::expected(std::vector<HandleInput>& hands) {
  hands.resize(tracks_.size());
  for (std::size_t h = 0; h < tracks_.size(); ++h) {
    Track& track = tracks_[h];
    track.take(track.expected(), track.engaged);
    hands[h] = hand_of(track.last, track.engaged);
  }
}

}  // namespace slosh::keep
