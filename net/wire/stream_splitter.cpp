#include "net/wire/stream_splitter.h"

#include <algorithm>

namespace slosh::wire {
namespace {

/// Two varints of shortest form, of values up to 255 and kMaxControlMessage, and one byte to find them too
/// long.
constexpr std::size_t kLongestHeader = 6;

struct Header {
  std::uint32_t type = 0;
  std::uint32_t length = 0;
};
template <class V>
void visit(V& v, Header& m) {
  v.natural("type", m.type, 0, 255);
  v.natural("length", m.length, 0, kMaxControlMessage);
}

}  // namespace

bool StreamSplitter::read_header() {
  const auto ended = [](std::uint8_t byte) { return byte < 0x80; };
  const auto numbers = std::count_if(header_.begin(), header_.end(), ended);
  if (numbers < 2 && header_.size() < kLongestHeader) return false;
  Header header;
  Fault fault = decode(header_, header);
  if (fault) {
    fault_ = fault;
    return false;
  }
  type_ = header.type;
  length_ = header.length;
  return true;
}

std::size_t StreamSplitter::take(ByteView bytes) {
  std::size_t used = 0;
  while (!header_read_ && used < bytes.size()) {
    header_.push_back(bytes[used++]);
    header_read_ = read_header();
    if (fault_) return used;
  }
  if (!header_read_) return used;
  const std::size_t wanted = std::min<std::size_t>(length_ - payload_.size(), bytes.size() - used);
  const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(used);
  payload_.insert(payload_.end(), from, from + static_cast<std::ptrdiff_t>(wanted));
  if (payload_.size() == length_) {
    complete_ = true;
    header_read_ = false;
  }
  return used + wanted;
}

Fault StreamSplitter::finish() const {
  if (fault_ || held() == 0) return fault_;
  return {"end", "the stream ends within a message"};
}

}  // namespace slosh::wire
