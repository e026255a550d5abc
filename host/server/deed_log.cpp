#include "host/server/deed_log.h"

#include <algorithm>
#include <ctime>

#include "net/clock.h"

namespace slosh {
namespace {

constexpr std::ptrdiff_t kJustBefore = 8;  // deeds

}  // namespace

void DeedLog::note(const std::string& words, std::int64_t unix_ns) {
  Deed deed{words, unix_ns, 1};
  const auto from = deeds_.end() - std::min<std::ptrdiff_t>(kJustBefore, std::ssize(deeds_));
  const auto same = std::find_if(from, deeds_.end(), [&](const Deed& each) { return each.words == words; });
  if (same != deeds_.end()) {
    deed.times += same->times;
    deeds_.erase(same);
  }
  deeds_.push_back(std::move(deed));
  if (deeds_.size() > kMaxDeeds) deeds_.pop_front();
}

std::string DeedLog::text() const {
  std::string text;
  for (const Deed& deed : deeds_) {
    const std::time_t seconds = deed.unix_ns / kNanosecondsPerSecond;
    std::tm local{};
    localtime_r(&seconds, &local);
    char time[16] = "";
    std::strftime(time, sizeof time, "%H:%M:%S", &local);
    text.append(text.empty() ? "" : "\n").append(time).append("  ").append(deed.words);
    if (deed.times > 1) text += " (" + std::to_string(deed.times) + " times)";
  }
  return text.empty() ? "nothing yet" : text;
}

}  // namespace slosh
