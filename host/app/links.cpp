// The verb `links`: the links of a host that runs, from another terminal.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "host/server/console.h"
#include "host/server/console_door.h"
#include "peer/app/verbs.h"

namespace slosh {
namespace {

constexpr const char* kLinksFooter =
    "Without an action the links are listed: id, what it allows, for whom, until when, who used it.\n"
    "\n"
    "Examples:\n"
    "  slosh links\n"
    "  slosh links new Ana --expires 30m\n"
    "  slosh links new --role watch\n"
    "  slosh links new Ben --role run               he may pause, reset and set gravity and viscosity, too\n"
    "  slosh links role bako run                    likewise whoever comes by this link\n"
    "  slosh links revoke bako\n"
    "  slosh links expire bako 10m\n"
    "\n"
    "The host must run on this machine, as the same user. Everything else that a host understands is typed\n"
    "where it runs; `help` there lists it.";

struct LinksOptions {
  std::uint16_t port = 0;
  std::string name;
  std::string id;
  std::string when;
  std::string expires;
  std::string role = "hold";
  bool watch = false;
};

Result<std::uint16_t> chosen_port(const LinksOptions& options) {
  if (options.port != 0) return options.port;
  std::vector<std::uint16_t> running;
  for (const std::uint16_t port : console_ports()) {
    if (ask_console(port, "")) running.push_back(port);
  }
  if (running.empty()) return Error{"", "no host runs here", "Start one with `slosh host SCENE`"};
  if (running.size() == 1) return running[0];
  std::string all;
  for (const std::uint16_t port : running) all += (all.empty() ? "" : ", ") + std::to_string(port);
  return Error{"", "several hosts run here", "Say which with --port: " + all};
}

int ask(const LinksOptions& options, const std::string& line) {
  const Result<std::uint16_t> port = chosen_port(options);
  if (!port) return fail(port.error());
  const Result<Outcome> answer = ask_console(port.value(), line);
  if (!answer) return fail(answer.error());
  std::printf("%s\n", answer.value().text.c_str());
  return answer.value().granted ? kExitOk : kExitFailed;
}

std::string in_quotes(const std::string& text) {
  return text.find('"') == std::string::npos ? "\"" + text + "\"" : "'" + text + "'";
}

}  // namespace

void add_links(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("links", "List, make, revoke the links of a host that runs here");
  auto o = std::make_shared<LinksOptions>();
  const auto time = CLI::Validator(
      [](std::string& text) {
        const Result<std::int64_t> parsed = parse_duration(text);
        return parsed || text == "never" ? std::string() : parsed.error().text();
      },
      "TIME");
  verb->add_option("--port", o->port, "The host's port, where several run")->check(CLI::Range(1, 65535));
  verb->require_subcommand(0, 1);
  verb->fallthrough();
  verb->footer(kLinksFooter);
  verb->callback([&chosen, o, verb] {
    if (verb->get_subcommands().empty()) chosen = [o] { return ask(*o, "links"); };
  });

  CLI::App* list = verb->add_subcommand("list", "Every link of the host");
  list->callback([&chosen, o] { chosen = [o] { return ask(*o, "links"); }; });

  CLI::App* make = verb->add_subcommand("new", "A new link, for anybody or for one person");
  make->add_option("NAME", o->name, "Whom it is for; it then works for one machine");
  CLI::Option* role =
      make->add_option("--role", o->role,
                       "hold: to take grips; watch: to look on; run: to hold, and to run the world for "
                       "everybody (pause, continue, reset, gravity, viscosity)");
  role->check(CLI::IsMember({"hold", "watch", "run"}))->capture_default_str();
  make->add_flag("--watch", o->watch, "The same as --role watch")->excludes(role);
  make->add_option("--expires", o->expires, "When it ends, e.g. 30m (never)")->check(time);
  make->callback([&chosen, o] {
    chosen = [o] {
      std::string line = "link";
      if (!o->name.empty()) line += " " + in_quotes(o->name);
      const std::string wanted = o->watch ? "watch" : o->role;
      if (wanted != "hold") line += " " + wanted;
      if (!o->expires.empty() && o->expires != "never") line += " for " + o->expires;
      return ask(*o, line);
    };
  });

  CLI::App* revoke = verb->add_subcommand("revoke", "End a link and close who came in by it");
  revoke->add_option("ID", o->id, "As the list shows it")->required();
  revoke->callback([&chosen, o] { chosen = [o] { return ask(*o, "revoke " + in_quotes(o->id)); }; });

  CLI::App* give = verb->add_subcommand("role", "Say whether those who come by a link may run the world");
  give->add_option("ID", o->id, "As the list shows it")->required();
  give->add_option("ROLE", o->role, "hold or run")->required()->check(CLI::IsMember({"hold", "run"}));
  give->callback(
      [&chosen, o] { chosen = [o] { return ask(*o, "role " + in_quotes(o->id) + " " + o->role); }; });

  CLI::App* expire = verb->add_subcommand("expire", "Let a link end later; who is in stays in");
  expire->add_option("ID", o->id, "As the list shows it")->required();
  expire->add_option("TIME", o->when, "From now, e.g. 10m, or never")->required()->check(time);
  expire->callback(
      [&chosen, o] { chosen = [o] { return ask(*o, "expire " + in_quotes(o->id) + " " + o->when); }; });
}

}  // namespace slosh
