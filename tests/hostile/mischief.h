// What somebody may send: messages that are valid and of any content, damaged ones, and bytes that are
// nothing. All random numbers come from one seed.
#pragma once

#include <random>
#include <string>

#include "net/wire/all_messages.h"
#include "tests/support/mutate.h"
#include "tests/support/randomize.h"

namespace slosh::hostile {

class Mischief {
 public:
  explicit Mischief(std::uint64_t seed) : random_(seed) {}

  std::uint64_t any() { return random_(); }
  /// 0 for a bound of 0.
  std::size_t below(std::size_t bound) { return bound == 0 ? 0 : random_() % bound; }
  bool one_in(std::size_t n) { return below(n) == 0; }

  wire::Bytes noise(std::size_t most);
  /// A text that nobody should show as it is: controls, escapes, what turns or hides writing, no UTF-8. At
  /// most `most` bytes.
  std::string text(std::size_t most);

  /// A message's payload: valid in half of the cases, else damaged in one field, cut, or with a few bits
  /// turned.
  template <class M>
  wire::Bytes payload(const M& message) {
    wire::Bytes bytes = wire::encoded(message);
    switch (below(8)) {
      case 0:
      case 1:
        return wire::damaged_message(message, below(64)).bytes;
      case 2:
        bytes.resize(below(bytes.size() + 1));
        return bytes;
      case 3:
        turn_bits(bytes);
        return bytes;
      default:
        return bytes;
    }
  }
  /// One of the list's messages in its envelope, which may be wrong too.
  template <class List>
  wire::Bytes control(List list) {
    return one_of(list, [&]<class M>(const M&) {
      return enveloped(static_cast<std::uint64_t>(M::kType), payload(wire::random_message<M>(any())));
    });
  }
  template <class List>
  wire::Bytes datagram(List list) {
    return one_of(list, [&]<class M>(const M&) {
      wire::Bytes bytes{static_cast<std::uint8_t>(M::kType)};
      const wire::Bytes inside = payload(wire::random_message<M>(any()));
      bytes.insert(bytes.end(), inside.begin(), inside.end());
      if (bytes.size() > wire::kMaxDatagram) bytes.resize(wire::kMaxDatagram);
      return bytes;
    });
  }
  /// `message`, valid, whose text of kMark is replaced by text(), which no Writer would write.
  template <class M>
  wire::Bytes with_text(M message, std::string M::* field, std::size_t most) {
    const std::string bad = text(most);
    (message.*field).assign(bad.size(), kMark);
    wire::Bytes bytes = wire::control(message);
    write_over(bytes, bad);
    return bytes;
  }

  void turn_bits(wire::Bytes& bytes);
  wire::Bytes enveloped(std::uint64_t type, const wire::Bytes& payload);

 private:
  static constexpr char kMark = '`';  // in no other field of these messages
  static void write_over(wire::Bytes& bytes, const std::string& text);

  template <class... M, class Make>
  wire::Bytes one_of(wire::MessageList<M...> list, Make&& make) {
    std::size_t left = below(sizeof...(M)) + 1;
    wire::Bytes out;
    wire::for_each_message(list, [&](const auto& message) {
      if (left > 0 && --left == 0) out = make(message);
    });
    return out;
  }

  std::mt19937_64 random_;
};

}  // namespace slosh::hostile
