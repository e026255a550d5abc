// Which tables WIRE_FORMAT.md has.
#include <functional>

#include "net/wire/acting_fields.h"
#include "net/wire/all_messages.h"
#include "net/wire/describe.h"

namespace slosh::wire {
namespace {

struct Table {
  std::string name;
  std::string text;
};

template <class M>
Describer described() {
  Describer describer;
  M message{};
  visit(describer, message);
  return describer;
}

template <class M>
Table message(const char* name) {
  return {name, "Type " + std::to_string(static_cast<int>(M::kType)) + ".\n\n" + field_table(described<M>())};
}

template <class M>
Table part(const char* name) {
  return {name, field_table(described<M>())};
}

std::vector<Table> tables() {
  return {message<Hello>("Hello"),
          message<GripRequest>("GripRequest"),
          message<WorldRequest>("WorldRequest"),
          message<ParameterRequest>("ParameterRequest"),
          message<Bye>("Bye"),
          message<Welcome>("Welcome"),
          message<Refused>("Refused"),
          message<Roster>("Roster"),
          message<RosterChange>("RosterChange"),
          message<Answer>("Answer"),
          message<WorldInfo>("WorldInfo"),
          message<Rights>("Rights"),
          message<Task>("Task"),
          message<Cuts>("Cuts"),
          message<Notice>("Notice"),
          message<Poses>("Poses"),
          message<ClockPing>("ClockPing"),
          message<SnapshotFeedback>("SnapshotFeedback"),
          message<ClockPong>("ClockPong"),
          message<Bodies>("Bodies"),
          message<Hands>("Hands"),
          message<FluidWrench>("FluidWrench"),
          part<SceneAt<kCutScene>>("Scene")};
}

constexpr const char kBegin[] = "<!-- table: ";
constexpr const char kBeginEnd[] = " -->";
constexpr const char kEnd[] = "<!-- end of table -->";

}  // namespace

std::vector<std::string> table_names() {
  std::vector<std::string> names;
  for (const Table& table : tables()) names.push_back(table.name);
  return names;
}

std::string fill_tables(const std::string& page) {
  const std::vector<Table> known = tables();
  std::string out;
  std::size_t at = 0;
  while (true) {
    const std::size_t begin = page.find(kBegin, at);
    const std::size_t name_end = begin == std::string::npos ? begin : page.find(kBeginEnd, begin);
    const std::size_t end = name_end == std::string::npos ? name_end : page.find(kEnd, name_end);
    if (end == std::string::npos) return out + page.substr(at);
    const std::size_t name_begin = begin + sizeof(kBegin) - 1;
    const std::string name = page.substr(name_begin, name_end - name_begin);
    std::string text = "There is no list '" + name + "'.\n";
    for (const Table& table : known) {
      if (table.name == name) text = table.text;
    }
    out += page.substr(at, name_end - at) + kBeginEnd + "\n\n" + text + "\n" + kEnd;
    at = end + sizeof(kEnd) - 1;
  }
}

}  // namespace slosh::wire
