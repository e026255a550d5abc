// Every message between a host and its peers, field by field. WIRE_FORMAT.md is made from these lists.
//
// Control messages travel on one bidirectional stream that the peer opens first: varint type, varint length,
// payload. The scene and nothing else travels on a unidirectional stream of the host's. Datagrams start with
// their type in one byte. A message that does not decode is answered as WIRE_FORMAT.md says and never acted
// on in part.
#pragma once

#include "net/wire/control_messages.h"
#include "net/wire/datagram_messages.h"

namespace slosh::wire {

/// Type and payload of a datagram in one array. Tells through `fault` what a Writer had to bring into range.
template <class M>
Bytes datagram(const M& message, Fault* fault = nullptr, Capabilities agreed = kAllCapabilities) {
  Bytes out{static_cast<std::uint8_t>(M::kType)};
  const Fault found = encode(message, out, agreed);
  if (fault) *fault = found;
  return out;
}

/// Type, length and payload of a control message; likewise.
template <class M>
Bytes control(const M& message, Fault* fault = nullptr, Capabilities agreed = kAllCapabilities) {
  Bytes payload;
  const Fault found = encode(message, payload, agreed);
  if (fault) *fault = found;
  Bytes out;
  Writer writer(out);
  std::uint64_t type = static_cast<std::uint64_t>(M::kType);
  std::uint64_t length = payload.size();
  writer.natural("type", type, 0, 255);
  writer.natural("length", length, 0, kMaxControlMessage);
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

}  // namespace slosh::wire
