// Every message type in one place: for those who decode by a type's number, and for the page and the tests
// that must leave none out.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

#include "net/wire/cuts.h"
#include "net/wire/fluid_wrench.h"
#include "net/wire/messages.h"

namespace slosh::wire {

template <class... M>
struct MessageList {};

using PeerControl = MessageList<Hello, GripRequest, WorldRequest, ParameterRequest, Bye>;
using HostControl =
    MessageList<Welcome, Refused, Roster, RosterChange, Answer, WorldInfo, Rights, Task, Cuts, Notice, Bye>;
using PeerDatagrams = MessageList<Poses, ClockPing, SnapshotFeedback>;
/// Without kSnapshotPiece, which net/codec reads.
using HostDatagrams = MessageList<ClockPong, Bodies, Hands, FluidWrench>;

/// Calls `call(message)` with an empty message of every type of the list.
template <class... M, class Call>
void for_each_message(MessageList<M...>, Call&& call) {
  (call(M{}), ...);
}

/// Decodes a payload as the type of the list that has this number and gives it to `handle(message)`, an
/// overload for each type, which returns nothing or a Fault. Returns the first fault: an unknown number, what
/// the payload lacks, or the handler's.
template <class... M, class Handle>
[[nodiscard]] Fault dispatch(MessageList<M...>, std::uint64_t type, ByteView payload, Handle&& handle,
                             Capabilities agreed = kAllCapabilities) {
  Fault fault{"type", std::to_string(type) + " is no message that may come here"};
  const auto attempt = [&]<class T>(T message) {
    if (type != static_cast<std::uint64_t>(T::kType)) return false;
    fault = decode(payload, message, agreed);
    if (fault) return true;
    if constexpr (std::is_void_v<decltype(handle(message))>)
      handle(message);
    else
      fault = handle(message);
    return true;
  };
  (attempt(M{}) || ...);
  return fault;
}

/// The same for a whole datagram, whose first byte is the type.
template <class... M, class Handle>
[[nodiscard]] Fault dispatch_datagram(MessageList<M...> list, ByteView datagram, Handle&& handle,
                                      Capabilities agreed = kAllCapabilities) {
  if (datagram.empty()) return {"type", "ends too early"};
  return dispatch(list, datagram[0], datagram.subspan(1), handle, agreed);
}

}  // namespace slosh::wire
