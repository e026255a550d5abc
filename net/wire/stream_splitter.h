// From the bytes of a control stream to its messages.
#pragma once

#include <cstdint>

#include "net/wire/messages.h"

namespace slosh::wire {

/// Takes a stream's bytes as they come, in pieces of any size, and gives each whole message: varint type,
/// varint length, payload. Holds back at most one message, and only as much of it as came; a length above
/// kMaxControlMessage is a fault before any of the payload is kept. After a fault nothing more is given: the
/// stream has lost its frame and the connection must end.
class StreamSplitter {
 public:
  /// Calls `each(type, payload)` for every message that is now complete, in order; the payload is valid
  /// during the call only. `each` returns a Fault to stop there. Returns the first fault, also every time
  /// after.
  template <class Each>
  Fault feed(ByteView bytes, Each&& each) {
    while (!fault_ && !bytes.empty()) {
      bytes = bytes.subspan(take(bytes));
      if (fault_ || !complete_) break;
      complete_ = false;
      fault_ = each(type_, ByteView(payload_));
      payload_.clear();
      header_.clear();
    }
    return fault_;
  }

  /// The stream has ended: a fault when that was within a message.
  Fault finish() const;

  std::size_t held() const { return header_.size() + payload_.size(); }  ///< bytes of the unfinished message

 private:
  /// Takes bytes of one message at most; tells how many.
  std::size_t take(ByteView bytes);
  bool read_header();

  Bytes header_;
  Bytes payload_;
  std::uint64_t type_ = 0;
  std::uint64_t length_ = 0;
  bool header_read_ = false;
  bool complete_ = false;
  Fault fault_;
};

}  // namespace slosh::wire
