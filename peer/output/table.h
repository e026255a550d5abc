// A table that grows by rows while a run goes on.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "sim/math/result.h"

namespace slosh {

/// A .csv file that at every moment ends after a whole row, on a disk that is full too: what of a row could
/// not be written is taken away again, and then nothing more is written. For one thread.
class Table {
 public:
  /// Writes the header line at once. Errors: the system's.
  static Result<std::unique_ptr<Table>> create(const std::filesystem::path& file, std::string_view header);
  ~Table();
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  /// A row with its line end; kept until flush(), or until there are some 64 kB.
  void add(std::string_view row);
  /// Hands what was added to the system. False when the table has ended early; problem() says why.
  bool flush();
  /// Empty while every row that was flushed is in the file.
  const std::string& problem() const { return problem_; }

 private:
  Table(std::filesystem::path path, int file) : path_(std::move(path)), file_(file) {}

  std::filesystem::path path_;
  int file_;
  std::string waiting_;
  std::string problem_;
};

}  // namespace slosh
