// The visitor that tells of a message's fields: the tables of WIRE_FORMAT.md.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "net/wire/fields.h"

namespace slosh::wire {

/// One line of a table.
struct FieldRow {
  std::string field;    ///< as a Fault names it
  std::string coding;   ///< "varint", "real32 × 3", …
  std::string bytes;    ///< "1", "1–5", "4 each"
  std::string range;    ///< what is taken
  std::string refused;  ///< the words that a bad value gets
};

/// Visits a default message: each list once, with one default element.
class Describer {
 public:
  static constexpr bool kReads = false;
  bool agreed(Capabilities) const { return true; }
  static constexpr std::uint64_t kUnbounded = std::numeric_limits<std::uint64_t>::max();

  const std::vector<FieldRow>& rows() const { return rows_; }
  std::uint64_t least_bytes() const { return least_; }
  std::uint64_t most_bytes() const { return most_; }  ///< kUnbounded when another field's value decides

  template <class T>
  void natural(std::string_view name, T&, std::uint64_t least, std::uint64_t most) {
    add_natural(name, least, most);
  }
  template <class T>
  void below(std::string_view name, T&, std::uint64_t most, std::string_view of, std::uint64_t) {
    add_below(name, most, of);
  }
  void index(std::string_view name, int&, std::string_view of, std::size_t, bool optional);
  void rule(std::string_view name, bool, std::string_view problem);
  void bits64(std::string_view name, std::uint64_t&);
  void stamp(std::string_view name, std::int64_t&);
  template <class T>
  void choice(std::string_view name, T&, std::uint64_t count) {
    add_choice(name, 0, count, nullptr, "");
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T&, const std::array<const char*, N>& names) {
    add_choice(name, 0, N, names.data(), "");
  }
  template <class T, std::size_t N>
  void choice_from(std::string_view name, T&, T first, const std::array<const char*, N>& names,
                   std::string_view gone) {
    add_choice(name, static_cast<std::uint64_t>(first), N, names.data(), gone);
  }
  void flag(std::string_view name, bool&);
  void real64(std::string_view name, double&, double least, double most) { add_real(name, 8, least, most); }
  template <class T>
  void real32(std::string_view name, T&, double least, double most) {
    add_real(name, 4, least, most);
  }
  template <class T>
  void vec3(std::string_view name, glm::vec<3, T>&, double limit) {
    add_vector(name, 4, limit);
  }
  void vec3_exact(std::string_view name, glm::dvec3&, double limit) { add_vector(name, 8, limit); }
  void direction(std::string_view name, glm::vec3&) { add_unit(name, "real32 × 3", 12, "1 %"); }
  void rotation(std::string_view name, glm::dquat&) { add_unit(name, "real32 × 4: w, x, y, z", 16, "1 %"); }
  void rotation_exact(std::string_view name, glm::dquat&) {
    add_unit(name, "real64 × 4: w, x, y, z", 32, "10⁻⁶");
  }
  void text(std::string_view name, std::string&, std::size_t most);
  void bytes(std::string_view name, Bytes&, std::size_t least, std::size_t most);
  template <std::size_t N>
  void array(std::string_view name, std::array<std::uint8_t, N>&) {
    add_array(name, N);
  }
  template <class T, class Each>
  void list(std::string_view name, std::vector<T>&, std::size_t most, Each&& each) {
    add_list(name, most);
    T element{};
    element_of(name, most, [&](Describer& inner) { each(inner, element); });
  }
  template <class T, class Each>
  void list_as_long(std::string_view name, std::vector<T>&, std::string_view of, std::size_t, Each&& each) {
    add_list_as_long(name, of);
    T element{};
    element_of(name, kUnbounded, [&](Describer& inner) { each(inner, element); });
  }
  template <class T, class Each>
  void each_of(std::string_view name, std::vector<T>& values, std::string_view of, Each&& each) {
    list_as_long(name, values, of, values.size(), each);
  }

 private:
  template <class Visit>
  void element_of(std::string_view name, std::uint64_t most, Visit&& visit_element) {
    Describer inner;
    inner.path_ = path_ + std::string(name) + ".";
    visit_element(inner);
    rows_.insert(rows_.end(), inner.rows_.begin(), inner.rows_.end());
    const bool bounded = most != kUnbounded && inner.most_ != kUnbounded && most_ != kUnbounded;
    most_ = bounded ? most_ + most * inner.most_ : kUnbounded;
  }
  void add(FieldRow row, std::string_view name, std::uint64_t least, std::uint64_t most);
  void add_natural(std::string_view name, std::uint64_t least, std::uint64_t most);
  void add_below(std::string_view name, std::uint64_t most, std::string_view of);
  void add_choice(std::string_view name, std::uint64_t first, std::uint64_t count, const char* const* names,
                  std::string_view gone);
  void add_real(std::string_view name, int size, double least, double most);
  void add_vector(std::string_view name, int size, double limit);
  void add_unit(std::string_view name, const char* coding, int size, const char* tolerance);
  void add_array(std::string_view name, std::size_t size);
  void add_list(std::string_view name, std::size_t most);
  void add_list_as_long(std::string_view name, std::string_view of);

  std::string path_;
  std::vector<FieldRow> rows_;
  std::uint64_t least_ = 0;
  std::uint64_t most_ = 0;
};

/// A Markdown table of the message's fields.
std::string field_table(const Describer& described);

/// `page` with the lines between each `<!-- table: NAME -->` and `<!-- end of table -->` made anew from the
/// messages' lists. A NAME that there is no list for gets a line that says so.
std::string fill_tables(const std::string& page);

/// Names that fill_tables knows, in the page's order.
std::vector<std::string> table_names();

}  // namespace slosh::wire
