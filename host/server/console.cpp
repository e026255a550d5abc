#include "host/server/console.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include "net/clock.h"
#include "net/wire/messages.h"
#include "net/wire/text.h"

namespace slosh {
namespace {

Error usage(const std::string& what, const std::string& mend) {
  return {"", what, mend};
}

Result<ConsoleCommand> parse_link_command(const std::vector<std::string>& words) {
  ConsoleCommand command;
  command.verb = ConsoleVerb::kLink;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (const auto role = link_role_named(words[i])) {
      command.role = *role;
    } else if (words[i] == "for") {
      if (i + 1 >= words.size()) return usage("'for' needs a time", "For example: link Ana for 30m");
      const Result<std::int64_t> lifetime = parse_duration(words[++i]);
      if (!lifetime) return lifetime.error();
      command.lifetime_ns = lifetime.value();
    } else if (command.text.empty()) {
      command.text = words[i];
    } else {
      return usage("'" + words[i] + "' is too much", "As in: link [NAME] [watch|run] [for 30m]");
    }
  }
  if (command.text.size() > wire::kMaxName)
    return usage("a name has at most " + std::to_string(wire::kMaxName) + " bytes", "Choose a shorter one");
  return command;
}

Result<ConsoleCommand> parse_expire(const std::vector<std::string>& words) {
  if (words.size() != 3) return usage("expire needs a link and a time", "For example: expire bako 10m");
  ConsoleCommand command;
  command.verb = ConsoleVerb::kExpire;
  command.text = words[1];
  if (words[2] == "never") return command;
  const Result<std::int64_t> lifetime = parse_duration(words[2]);
  if (!lifetime) return lifetime.error();
  command.lifetime_ns = lifetime.value();
  return command;
}

Result<ConsoleCommand> parse_role(const std::vector<std::string>& words) {
  const auto role = words.size() == 3 ? link_role_named(words[2]) : std::nullopt;
  if (!role || !may_hold(*role))
    return usage("role needs a link, and hold or run", "For example: role bako run");
  ConsoleCommand command;
  command.verb = ConsoleVerb::kRole;
  command.text = words[1];
  command.role = *role;
  return command;
}

Result<ConsoleCommand> parse_kick(const std::vector<std::string>& words) {
  const bool for_a_time = words.size() == 4 && words[2] == "for";
  if (words.size() != 2 && !for_a_time)
    return usage("kick needs a person's name, as `who` shows it",
                 "As in: kick Ana, or: kick 'Ana 2' for 10m");
  ConsoleCommand command;
  command.verb = ConsoleVerb::kKick;
  command.text = words[1];
  if (!for_a_time) return command;
  const Result<std::int64_t> time = parse_duration(words[3]);
  if (!time) return time.error();
  command.lifetime_ns = time.value();
  return command;
}

Result<ConsoleCommand> parse_set_command(const std::vector<std::string>& words) {
  const Result<SetWish> wish = parse_set(words);
  if (!wish) return wish.error();
  ConsoleCommand command;
  command.verb = ConsoleVerb::kSet;
  command.what = wish.value().what;
  command.text = wish.value().which;
  command.value = wish.value().value;
  return command;
}

}  // namespace

Result<std::int64_t> parse_duration(std::string_view text) {
  const Error error = usage(std::string("'").append(wire::clean_text(text, 40)).append("' is no time"),
                            "For example 90s, 10m, 2h, 1d or 1h30m");
  std::int64_t seconds = 0;
  std::size_t at = 0;
  while (at < text.size()) {
    std::int64_t count = 0;
    const auto [end, code] = std::from_chars(text.data() + at, text.data() + text.size(), count);
    if (code != std::errc() || count < 0 || count > 1'000'000'000) return error;
    at = static_cast<std::size_t>(end - text.data());
    if (at >= text.size()) return error;
    const char unit = text[at++];
    const std::int64_t scale = unit == 's'   ? 1
                               : unit == 'm' ? 60
                               : unit == 'h' ? 3600
                               : unit == 'd' ? 86400
                                             : 0;
    if (scale == 0) return error;
    seconds += count * scale;
    if (seconds > 10ll * 365 * 86400) return error;
  }
  if (seconds < 1) return error;
  return seconds * kNanosecondsPerSecond;
}

std::string duration_text(std::int64_t ns) {
  const std::int64_t seconds = std::max<std::int64_t>(0, ns / kNanosecondsPerSecond);
  const auto text = [](std::int64_t n, const char* unit) {
    return std::to_string(n).append(" ").append(unit);
  };
  if (seconds < 60) return text(seconds, "s");
  if (seconds < 3600) return text(seconds / 60, "min");
  if (seconds < 86400)
    return text(seconds / 3600, "h")
        .append(seconds / 60 % 60 ? " " : "")
        .append(seconds / 60 % 60 ? text(seconds / 60 % 60, "min") : "");
  return text(seconds / 86400, seconds < 2 * 86400 ? "day" : "days");
}

Result<ConsoleCommand> parse_console(std::string_view typed) {
  const Result<std::vector<std::string>> split = console_words(typed);
  if (!split) return split.error();
  const std::vector<std::string>& words = split.value();
  const Result<ConsoleVerb> verb = console_verb(Console::kHost, words);
  if (!verb) return verb.error();
  switch (verb.value()) {
    case ConsoleVerb::kLink:
      return parse_link_command(words);
    case ConsoleVerb::kExpire:
      return parse_expire(words);
    case ConsoleVerb::kRole:
      return parse_role(words);
    case ConsoleVerb::kKick:
      return parse_kick(words);
    case ConsoleVerb::kSet:
      return parse_set_command(words);
    default:
      break;
  }
  ConsoleCommand command;
  command.verb = verb.value();
  if (words.size() > 1) command.text = words[1];
  return command;
}

}  // namespace slosh
