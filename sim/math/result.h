// A value or an error that says where, what and how to mend it.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace slosh {

/// What went wrong while setting something up.
struct Error {
  std::string where;  ///< file, node and field, e.g. "bucket.gltf: node 'bucket': extras.mass_kg"
  std::string what;   ///< what is wrong, with the offending value
  std::string mend;   ///< what the user can do about it

  /// "where: what. mend." on one line, as shown to the user.
  std::string text() const {
    std::string line = where.empty() ? what : where + ": " + what;
    if (!mend.empty()) line += ". " + mend;
    return line;
  }
};

/// Either a T or an Error. value() and error() assert that they are there.
template <class T>
class Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(std::move(error)) {}

  explicit operator bool() const { return std::holds_alternative<T>(content_); }
  T& value() { return std::get<T>(content_); }
  const T& value() const { return std::get<T>(content_); }
  const Error& error() const { return std::get<Error>(content_); }

 private:
  std::variant<T, Error> content_;
};

}  // namespace slosh
