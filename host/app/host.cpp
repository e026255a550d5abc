// The verb `host`: its options and what it teaches.
#include <CLI/CLI.hpp>
#include <memory>

#include "host/app/host_options.h"
#include "host/server/console.h"
#include "net/text/name.h"
#include "net/wire/messages.h"
#include "peer/app/common_options.h"
#include "peer/app/verbs.h"

namespace slosh {
namespace {

std::string footer() {
  return R"(Two links are printed: who joins by the first may take hold, who comes by the second may watch.
A link is all that a newcomer needs: they start slosh join or slosh watch, and paste it when asked.
It carries this machine's addresses, the key by which the host is known, and a secret. Give it only
to those you mean. A log of the host's does not hold it, --links FILE does, for your eyes alone.
Across the internet the port (UDP) must reach this machine.

Until a grip is taken the host itself holds it where the scene has it, and the world stands still
until the first hand takes hold (--wait 2: the second; --wait 0: it starts at once).

Who holds a grip sets how stiff it is. What everybody feels (pause, continue, reset, gravity, viscosity)
is yours, and theirs to whom you give it: --run NAME, or `slosh links new NAME --role run`, or the
console's `role`. Nobody but you may do that as often and as much as they like; `log` says who did what.

While it runs, type (or use `slosh links` from elsewhere):
)" + console_help(Console::kHost) +
         R"(

The world is saved to a file twice a second. Should a fault end it, or should it hang for a minute,
it is started again from there, and peers come back by themselves (not with --checkpoint none).
A large world is saved less often with --checkpoint-every. After the machine went
down, --resume FILE does the same. Key and links are in FILE.secrets: FILE alone can be given away.

Examples:
  slosh host bucket
  slosh host bucket --for Ana --for Ben --wait 2 --expires 2h
  slosh host bucket --run Ana
  slosh host pour --listen 192.168.1.20:5000 --record pour.rec
  slosh host --resume ~/.local/state/slosh/bucket.checkpoint)";
}

}  // namespace

void add_host(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("host", "Let others in: print links to join by and to watch by");
  auto o = std::make_shared<HostVerbOptions>();
  const CLI::Validator name(
      [](std::string& text) {
        if (text.empty() || text.size() > wire::kMaxName) return std::string("a name has 1 to 32 bytes");
        return std::string(clean_name(text).empty() ? "letters and digits make a name" : "");
      },
      "NAME");
  verb->add_option("SCENE", o->scene, "A shipped scene's name, or a .gltf or .glb file")
      ->capture_default_str();
  verb->add_option("--listen", o->listen, "ADDR:PORT, e.g. 0.0.0.0:4433 or [::1]:0 ([::]:4433: everywhere)");
  verb->add_option(
          "--address", o->addresses,
          "ADDR:PORT to put into links, again for more: a router's that passes it on (this machine's)")
      ->allow_extra_args(false);
  verb->add_option("--for", o->names, "A link of their own for these people; it works for one machine each")
      ->check(name);
  verb->add_option("--run", o->runners,
                   "The same with the right to run the world: pause, continue, reset, gravity, viscosity")
      ->check(name);
  verb->add_option("--expires", o->expires,
                   "When the links admit nobody new any more, e.g. 90m or 2h (never); who is in stays in")
      ->check(CLI::Validator(
          [](std::string& text) {
            const Result<std::int64_t> time = parse_duration(text);
            return time ? std::string() : time.error().text();
          },
          "TIME"));
  verb->add_option("--links", o->links_file,
                   "File for the links, one a line: hold LINK, watch LINK, run LINK NAME");
  verb->add_flag(
      "--show-links", o->show_links,
      "Print links whole also where standard output is no terminal but a log (else without their secret)");
  verb->add_option("--max-watchers", o->watchers, "People who may watch at a time")
      ->check(CLI::Range(0, 900))
      ->capture_default_str();
  verb->add_option("--wait", o->wait, "Grips that must be held before the world starts")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  verb->add_flag("--lock-parameters", o->lock_parameters,
                 "Only the host sets viscosity, gravity and stiffness (else the first two who may run the "
                 "world, too, and "
                 "of a grip its holder)");
  add_never_a_window_option(*verb, "No window: a host has none anyway; `slosh watch LINK` shows its world");
  add_seconds_option(*verb, o->seconds, 0.01, "Simulated seconds (until it is ended)");
  add_world_options(*verb, *o, "all but one");
  verb->add_option("--record", o->record, "File to record the run in; slosh replay plays it again");
  add_out_options(
      *verb, *o,
      "Folder for bodies.csv and probes.csv, what the instruments read, and for frames (nothing is written)");
  add_measure_option(*verb, *o)->needs(verb->get_option("--out"));
  add_export_options(*verb, *o);
  verb->get_option("--export")->needs(verb->get_option("--out"));
  verb->add_option("--checkpoint", o->checkpoint,
                   "File to save the world in, or none (~/.local/state/slosh/SCENE.checkpoint)");
  verb->add_option("--checkpoint-every", o->checkpoint_seconds, "Seconds between two checkpoints")
      ->check(in_range(0.1, 3600.0))
      ->capture_default_str();
  verb->add_option("--resume", o->resume, "Checkpoint to carry on from, with its links and its people");
  verb->add_flag("!--no-supervisor", o->supervised,
                 "Run the world in this very process, for a debugger; a fault then ends the host");
  verb->footer(footer());
  verb->callback([&chosen, o] { chosen = [o] { return host_world(*o); }; });
}

}  // namespace slosh
