#include "net/wire/describe.h"

#include <cstdio>

namespace slosh::wire {
namespace {

std::uint64_t varint_bytes(std::uint64_t value) {
  std::uint64_t count = 1;
  while (value >>= 7) ++count;
  return count;
}

std::string natural_text(std::uint64_t value) {
  for (int power = 24; power < 64; ++power) {
    const std::uint64_t whole = std::uint64_t{1} << power;
    if (value == whole) return "2^" + std::to_string(power);
    if (value == whole - 1) return "2^" + std::to_string(power) + " − 1";
  }
  return std::to_string(value);
}

std::string real_text(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", value);
  return text;
}

std::string span_text(std::uint64_t least, std::uint64_t most) {
  return least == most ? std::to_string(least) : std::to_string(least) + "–" + std::to_string(most);
}

std::string times(int size, int count) {
  return (size == 8 ? "real64 × " : "real32 × ") + std::to_string(count);
}

}  // namespace

void Describer::add(FieldRow row, std::string_view name, std::uint64_t least, std::uint64_t most) {
  row.field = path_ + std::string(name);
  if (row.bytes.empty()) row.bytes = span_text(least, most);
  rows_.push_back(std::move(row));
  least_ += least;
  most_ = most_ == kUnbounded || most == kUnbounded ? kUnbounded : most_ + most;
}

void Describer::add_natural(std::string_view name, std::uint64_t least, std::uint64_t most) {
  std::string refused = "N is above " + natural_text(most);
  if (least > 0) refused = "N is below " + natural_text(least) + "; " + refused;
  add({"", "varint", "", natural_text(least) + " to " + natural_text(most), refused}, name,
      varint_bytes(least), varint_bytes(most));
}

void Describer::add_below(std::string_view name, std::uint64_t most, std::string_view of) {
  const std::string words(of);
  add({"", "varint", "", "0 to " + natural_text(most) + ", below " + words, "N is not below " + words}, name,
      1, varint_bytes(most));
}

void Describer::index(std::string_view name, int&, std::string_view of, std::size_t, bool optional) {
  const std::string words(of);
  add({"", "varint", "1–5", std::string(optional ? "0 = none, else " : "") + "1 + an index into " + words,
       (optional ? "" : "is missing; ") + ("N is not below " + words)},
      name, 1, 5);
}

void Describer::rule(std::string_view name, bool, std::string_view problem) {
  add({"", "rule", "0", "", std::string(problem)}, name, 0, 0);
}

void Describer::bits64(std::string_view name, std::uint64_t&) {
  add({"", "8 bytes", "", "any", "—"}, name, 8, 8);
}

void Describer::stamp(std::string_view name, std::int64_t&) {
  add({"", "int64", "", "±(2^61 − 1)", "N ns is out of range"}, name, 8, 8);
}

void Describer::add_choice(std::string_view name, std::uint64_t first, std::uint64_t count,
                           const char* const* names, std::string_view gone) {
  std::string range = names ? "" : "0 to " + std::to_string(count - 1);
  for (std::uint64_t i = 0; names && i < count; ++i) {
    range += (i == 0 ? "" : ", ") + std::to_string(first + i) + " " + names[i];
  }
  std::string refused = "N is none of the " + std::to_string(count) + " choices";
  if (first > 0) refused = "N " + std::string(gone) + "; " + refused;
  add({"", "varint", "", range, refused}, name, 1, varint_bytes(first + count - 1));
}

void Describer::flag(std::string_view name, bool&) {
  add({"", "byte", "", "0 or 1", "N is neither 0 nor 1"}, name, 1, 1);
}

void Describer::add_real(std::string_view name, int size, double least, double most) {
  add({"", size == 8 ? "real64" : "real32", "", real_text(least) + " to " + real_text(most),
       "is not a finite number; X is below or above the range's end"},
      name, static_cast<std::uint64_t>(size), static_cast<std::uint64_t>(size));
}

void Describer::add_vector(std::string_view name, int size, double limit) {
  const auto all = static_cast<std::uint64_t>(3 * size);
  add({"", times(size, 3), "", "each ±" + real_text(limit),
       "is not a finite number; X is below or above the range's end"},
      name, all, all);
}

void Describer::add_unit(std::string_view name, const char* coding, int size, const char* tolerance) {
  add({"", coding, "", std::string("of length 1 within ") + tolerance,
       "is not a finite number; is not of unit length"},
      name, static_cast<std::uint64_t>(size), static_cast<std::uint64_t>(size));
}

void Describer::text(std::string_view name, std::string&, std::size_t most) {
  const std::string limit = std::to_string(most);
  add({"", "varint count, UTF-8", "", "at most " + limit + " bytes, no control characters",
       "N bytes are above " + limit + "; is not UTF-8 at byte N; has a control character at byte N"},
      name, 1, varint_bytes(most) + most);
}

void Describer::bytes(std::string_view name, Bytes&, std::size_t least, std::size_t most) {
  add({"", "varint count, bytes", "", span_text(least, most) + " bytes",
       "N bytes are below or above the range's end"},
      name, varint_bytes(least) + least, varint_bytes(most) + most);
}

void Describer::add_array(std::string_view name, std::size_t size) {
  add({"", "bytes", "", "any", "—"}, name, size, size);
}

void Describer::add_list(std::string_view name, std::size_t most) {
  const std::string limit = std::to_string(most);
  add({"", "varint count, that many of", "", "0 to " + limit, "N entries are above " + limit}, name, 1,
      varint_bytes(most));
}

void Describer::add_list_as_long(std::string_view name, std::string_view of) {
  add({"", "no count: one for each of " + std::string(of), "0", "", "—"}, name, 0, 0);
}

std::string field_table(const Describer& described) {
  std::string out =
      "| field | on the wire | bytes | range | a bad value is refused as |\n|---|---|---|---|---|\n";
  for (const FieldRow& row : described.rows()) {
    const std::string field =
        row.coding == "rule" ? std::string("(").append(row.field).append(")") : row.field;
    for (const std::string& cell : {field, row.coding, row.bytes, row.range, row.refused})
      out.append("| ").append(cell).append(" ");
    out.append("|\n");
  }
  out.append("\n").append(std::to_string(described.least_bytes()));
  if (described.most_bytes() == Describer::kUnbounded)
    out += " bytes or more.\n";
  else if (described.most_bytes() != described.least_bytes())
    out += " to " + std::to_string(described.most_bytes()) + " bytes.\n";
  else
    out += " bytes.\n";
  return out;
}

}  // namespace slosh::wire
