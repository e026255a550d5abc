#include "peer/output/table.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace slosh {
namespace {

constexpr std::size_t kMaxWaiting = 64 * 1024;  // bytes

}  // namespace

Result<std::unique_ptr<Table>> Table::create(const std::filesystem::path& file, std::string_view header) {
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  const Error cannot{file.string(), "cannot be written: " + std::generic_category().message(errno),
                     "Choose another folder with --out"};
  if (opened < 0) return cannot;
  std::unique_ptr<Table> table(new Table(file, opened));
  table->add(std::string(header) + "\n");
  if (!table->flush()) return Error{"", table->problem(), "Choose another folder with --out"};
  return table;
}

Table::~Table() {
  close(file_);
}

void Table::add(std::string_view row) {
  if (problem_.empty()) waiting_ += row;
  if (waiting_.size() >= kMaxWaiting) flush();
}

bool Table::flush() {
  std::string_view rest = waiting_;
  while (problem_.empty() && !rest.empty()) {
    const ssize_t done = write(file_, rest.data(), rest.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) {
      problem_ = path_.string() + " ends early: " + std::generic_category().message(errno);
      break;
    }
    rest.remove_prefix(static_cast<std::size_t>(done));
  }
  if (!problem_.empty() && !waiting_.empty()) {
    const std::size_t written = waiting_.size() - rest.size();
    const std::size_t last_end = waiting_.rfind('\n', written == 0 ? std::string::npos : written - 1);
    const std::size_t whole = written == 0 || last_end == std::string::npos ? 0 : last_end + 1;
    const off_t size = lseek(file_, 0, SEEK_CUR);
    // Shrinking takes no space; should it fail all the same, readers name the line that is cut short.
    if (whole < written && ftruncate(file_, size - static_cast<off_t>(written - whole)) != 0) return false;
  }
  waiting_.clear();
  return problem_.empty();
}

}  // namespace slosh
