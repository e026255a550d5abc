#include "peer/output/later_table.h"

#include <chrono>
#include <utility>

#include "net/text/spreadsheet.h"

namespace slosh {

Result<std::unique_ptr<LaterTable>> LaterTable::create(const std::filesystem::path& file,
                                                       std::string_view header) {
  Result<std::unique_ptr<Table>> table = Table::create(file, header);
  if (!table) return table.error();
  return std::unique_ptr<LaterTable>(new LaterTable(std::move(table.value())));
}

LaterTable::LaterTable(std::unique_ptr<Table> table) : table_(std::move(table)) {
  thread_ = std::thread([this] {
    while (!stop_.load(std::memory_order_relaxed)) {
      write();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
}

LaterTable::~LaterTable() {
  stop();
}

void LaterTable::add(std::string_view row) {
  const std::lock_guard lock(mutex_);
  waiting_ += row;
}

void LaterTable::stop() {
  if (!thread_.joinable()) return;
  stop_.store(true, std::memory_order_relaxed);
  thread_.join();
  write();
}

std::string LaterTable::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

void LaterTable::write() {
  std::string rows;
  {
    const std::lock_guard lock(mutex_);
    rows.swap(waiting_);
  }
  if (rows.empty()) return;
  table_->add(rows);
  if (table_->flush()) return;
  const std::lock_guard lock(mutex_);
  problem_ = table_->problem();
}

std::string csv_cell(std::string_view name) {
  std::string text = as_spreadsheet_text(name);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

}  // namespace slosh
