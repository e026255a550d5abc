// One list of fields a message; whoever visits the list encodes, decodes, describes or damages the message.
//
// A message type has one free function, found by argument-dependent lookup:
//
//   template <class V> void visit(V& v, PoseSample& m) {
//     v.natural("device", m.device, 0, kMaxDevices - 1);
//     ...
//   }
//
// The visitors are Writer and Reader, Describer (WIRE_FORMAT.md) in describe.h, and, for tests and fuzzers,
// Randomizer and Mutator in tests/support. All numbers are little-endian; counts and naturals
// are LEB128 varints in their shortest form. What a list may name:
//
//   natural(name, value, least, most)            varint
//   below(name, value, most, of, bound)          varint, less than another field's value, at most `most`
//   index(name, int, of, count, optional)        varint, 1 + an index into a list of `count`; 0 = none (−1)
//   bits64(name, value)                          8 bytes, any: hashes
//   stamp(name, value)                           8 bytes, ns of a clock, within ±kMaxStamp
//   choice(name, value, names | count)           varint, one of an enum's values
//   choice_from(name, value, first, names, gone) the same of values from `first` on; `gone` says what those
//                                                below were
//   flag(name, bool)                             a byte, 0 or 1
//   real64, real32(name, value, least, most)     8 or 4 bytes, finite
//   vec3, vec3_exact(name, value, limit)         three real32 or real64, each within ±limit
//   direction(name, vec3)                        three real32, of unit length within 1 %
//   rotation(name, quat)                         w, x, y, z as real32, of unit length within 1 %, and brought
//                                                to unit length when read
//   rotation_exact(name, quat)                   w, x, y, z as real64, of unit length within 1e-6, read as is
//   text(name, string, most)                     varint count of bytes, text.h
//   bytes(name, bytes, least, most)              varint count of bytes, any
//   array(name, array)                           that many bytes, any
//   list(name, vector, most, each)               varint count of elements; each(visitor, element)
//   list_as_long(name, vector, of, count, each)  as many elements as another list has
//   each_of(name, vector, of, each)              the elements that are there already, which `of` says
//   rule(name, holds, problem)                   nothing on the wire: what must hold between fields
//
// A field that is written only in some cases follows a flag or choice: `if (m.flag) v.natural(...)`, or asks
// for a capability (capabilities.h): `if (v.agreed(kX)) v.natural(...)`.
#pragma once

#include "net/wire/reader.h"
#include "net/wire/writer.h"
#include "sim/math/pose.h"

namespace slosh::wire {

/// Appends a message to `out`. Tells of the first value that had to be brought into range (Writer).
template <class M>
Fault encode(const M& message, Bytes& out, Capabilities agreed = kAllCapabilities) {
  Writer writer(out, agreed);
  visit(writer, const_cast<M&>(message));  // a Writer reads only
  return writer.fault();
}
template <class M>
Bytes encoded(const M& message, Capabilities agreed = kAllCapabilities) {
  Bytes out;
  encode(message, out, agreed);
  return out;
}

/// Reads a whole message; on a fault `message` is half read and must not be used.
template <class M>
[[nodiscard]] Fault decode(ByteView in, M& message, Capabilities agreed = kAllCapabilities) {
  Reader reader(in, agreed);
  visit(reader, message);
  reader.finish();
  return reader.fault();
}

}  // namespace slosh::wire
