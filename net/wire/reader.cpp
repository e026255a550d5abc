#include "net/wire/reader.h"

#include <cstdio>

namespace slosh::wire {
namespace {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", value);
  return text;
}

}  // namespace

bool Reader::varint(std::string_view name, std::uint64_t& value) {
  if (!ok()) return false;
  std::uint64_t result = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    if (at_ >= in_.size()) return fail(name, "ends too early"), false;
    const std::uint8_t byte = in_[at_++];
    if (shift == 63 && byte > 1) break;
    result |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
    if (byte < 0x80) {
      if (byte == 0 && shift > 0) return fail(name, "is a number written too long"), false;
      value = result;
      return true;
    }
  }
  return fail(name, "is a number too long for 64 bits"), false;
}

void Reader::text(std::string_view name, std::string& value, std::size_t most) {
  std::uint64_t count = 0;
  if (!varint(name, count)) return;
  if (count > most) return fail(name, std::to_string(count) + " bytes are above " + std::to_string(most));
  if (count > left()) return fail(name, "ends too early");
  const std::string_view raw(reinterpret_cast<const char*>(in_.data()) + at_, count);
  std::string problem = text_problem(raw);
  if (!problem.empty()) return fail(name, std::move(problem));
  value = raw;
  at_ += count;
}

void Reader::bytes(std::string_view name, Bytes& value, std::size_t least, std::size_t most) {
  std::uint64_t count = 0;
  if (!varint(name, count)) return;
  if (count < least) return fail(name, std::to_string(count) + " bytes are below " + std::to_string(least));
  if (count > most) return fail(name, std::to_string(count) + " bytes are above " + std::to_string(most));
  if (count > left()) return fail(name, "ends too early");
  const ByteView raw = in_.subspan(at_, count);
  value.assign(raw.begin(), raw.end());
  at_ += count;
}

void Reader::out_of_range(std::string_view name, std::uint64_t raw, std::uint64_t least, std::uint64_t most) {
  fail(name, std::to_string(raw) +
                 (raw < least ? " is below " + std::to_string(least) : " is above " + std::to_string(most)));
}

void Reader::out_of_range(std::string_view name, double raw, double least, double most) {
  if (!std::isfinite(raw)) return fail(name, "is not a finite number");
  fail(name, short_number(raw) +
                 (raw < least ? " is below " + short_number(least) : " is above " + short_number(most)));
}

std::string Reader::not_below(std::uint64_t raw, std::string_view of, std::uint64_t bound) {
  return std::to_string(raw) + " is not below " + std::string(of) + " (" + std::to_string(bound) + ")";
}

}  // namespace slosh::wire
