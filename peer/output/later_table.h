// A table for rows that come from a thread which must not wait for a disk.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "peer/output/table.h"

namespace slosh {

/// Takes rows on any one thread and writes them on its own, some twenty times a second.
class LaterTable {
 public:
  /// As Table::create.
  static Result<std::unique_ptr<LaterTable>> create(const std::filesystem::path& file,
                                                    std::string_view header);
  ~LaterTable();
  LaterTable(const LaterTable&) = delete;
  LaterTable& operator=(const LaterTable&) = delete;

  /// A row with its line end.
  void add(std::string_view row);
  /// Writes what is left; nothing is taken any more.
  void stop();
  /// As Table::problem; at any time, from any thread.
  std::string problem() const;

 private:
  explicit LaterTable(std::unique_ptr<Table> table);
  void write();

  std::unique_ptr<Table> table_;  // the writing thread's
  mutable std::mutex mutex_;
  std::string waiting_;
  std::string problem_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// A name as one cell of a CSV file: quoted where it has to be, and no formula (net/text/spreadsheet.h).
std::string csv_cell(std::string_view name);

}  // namespace slosh
