// The verbs `join` and `watch`: somebody else's world, by a link.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>

#include "net/clock.h"
#include "net/console_verbs.h"
#include "net/link.h"
#include "peer/app/common_options.h"
#include "peer/app/find_headset.h"
#include "peer/app/interrupt.h"
#include "peer/app/play_modes.h"
#include "peer/app/remote_run.h"
#include "peer/app/verbs.h"
#include "peer/haptics/make_device.h"
#include "peer/remote/link_source.h"
#include "peer/remote/peer_key.h"
#include "peer/view/headless_view.h"
#include "render/context.h"

namespace slosh {
namespace {

struct JoinOptions : ShowOptions {
  std::string link;
  std::string link_file;
  std::string name;
  std::vector<std::string> grips;
  std::string key;
  std::string coupling = "replica";
  bool watch = false;
};

constexpr const char* kFiles =
    "Without a display, or with --headless, the run becomes a film. DIR gets what `play` writes: view.mp4,\n"
    "final.png, summary.json (with what the network was like)";

constexpr const char* kJoinFiles =
    R"(; and of the hands that were yours wrenches.csv,
poses.csv and wrenches.png.

The link is all that is needed: the host prints it, and the scene comes over the network. It is a secret:
without LINK it is asked for, and not shown while it is pasted. Breaks that a mail program put in do no
harm. --link-file FILE, or standard input, does for programs. A LINK in the command line works too, and is
taken out of what `ps` shows at once, but a shell remembers it.

You are one person by the key in $XDG_DATA_HOME/slosh/peer_key: when contact is lost, you get your place
and your grips back, also after this program was ended and started again, within a minute.

While it runs, type in the terminal:
)";

constexpr const char* kJoinEnd =
    "\n\n"
    "In the window: drag what you hold, or one of its handles, to move it (H has all keys); G takes a free\n"
    "grip or lets go, Space pauses the world for everybody, R starts it again for everybody, left drag\n"
    "elsewhere turns the camera, the wheel zooms, Esc ends. Ctrl-C ends in order.\n"
    "\n"
    "Examples:\n"
    "  slosh join\n"
    "  slosh join --name Ana --grip left_hand --device mouse\n"
    "  slosh join --name Ben --vr --device xr-right\n"
    "  slosh join --link-file links.txt --headless --seconds 10 --out out/ana";

constexpr const char* kWatchFiles =
    ".\n"
    "\n"
    "The link is all that is needed: the host prints one for those who only look on. It is asked for, and "
    "not\n"
    "shown while it is pasted; --link-file FILE, or standard input, does for programs.\n"
    "\n"
    "While it runs, type in the terminal:\n";

constexpr const char* kWatchEnd =
    "\n\n"
    "Examples:\n"
    "  slosh watch\n"
    "  slosh watch --link-file links.txt --headless --seconds 10 --out out/film";

/// Waits for the scene and the first state. Errors: no answer, refused, a bad host, Ctrl-C.
Result<bool> wait_for_world(RemoteVisit& visit, Progress& progress) {
  for (;;) {
    const LinkState state = visit.wait_until_live(std::chrono::milliseconds(50));
    for (const std::string& notice : visit.take_notices()) progress.note(notice);
    if (state == LinkState::kLive) return true;
    if (state == LinkState::kEnded) {
      const RemoteStatus status = visit.status();
      if (status.error) return *status.error;
      return Error{"", "the host ended before the world came: " + status.farewell, ""};
    }
    if (interrupted_by() != 0) return Error{"", "interrupted while joining", ""};
  }
}

std::string welcome_text(const RemoteStatus& status) {
  const bool guest = status.welcome.role == wire::Role::kParticipant;
  std::string text = "you are " + status.welcome.name + (guest ? "" : ", looking on");
  if (status.welcome.restored) text += "; your place was kept";
  const std::size_t others = others_here(status);
  if (others > 0)
    text += "; " + std::to_string(others) + (others == 1 ? " other is here" : " others are here");
  return text;
}

int join(JoinOptions options) {
  // Before signals are caught: at the prompt they end the program.
  const Result<std::string> link_text =
      read_link_text(options.link, options.link_file,
                     options.watch ? wire::Role::kSpectator : wire::Role::kParticipant, options.name);
  if (!link_text) return fail(link_text.error());
  const std::int64_t begin_ns = steady_now_ns();
  catch_interrupts();
  Progress progress;
  const Result<JoinLink> link = parse_link(link_text.value());
  if (!link) return fail(link.error());
  if (const Result<std::pair<int, int>> size = parse_size(options.size); !options.size.empty() && !size) {
    return fail(size.error());
  }
  const Result<PeerKey> key = open_peer_key(options.key);
  if (!key) return fail(key.error());
  if (!key.value().note.empty()) progress.note("slosh: " + key.value().note);
  // Before the network's threads: name lookups and TLS read the environment, which both of these may write.
  const std::unique_ptr<HeadsetView> headset = find_headset(options, progress);
  if (headset) options.controllers = headset->link();
  const bool headless = is_film(options, headset != nullptr, progress);
  if (const std::optional<Error> missing = no_film(options, headless)) return fail(*missing, progress);
  if (headless && options.render) set_software_threads(kViewSoftwareThreads);

  RemoteOptions remote;
  remote.token = link.value().token;
  remote.name = options.name;
  for (const std::string& address : link.value().addresses) {
    remote.address += (remote.address.empty() ? "" : ", ") + address;
  }
  remote.wants_grip = !options.watch;
  remote.grips = options.grips;
  // Only a replica that a hand feels uses them.
  remote.fluid_models =
      options.coupling == "replica" && std::any_of(options.devices.begin(), options.devices.end(), is_felt);
  remote.snapshots.wanted = options.render;
  remote.snapshots.film = headless && options.render;
  remote.snapshots.frames_per_second = options.frames_per_second;
  progress.phase("joining", remote.address);
  RemoteVisit visit(remote, connect_by(link.value(), key.value().identity));
  const Result<bool> came = wait_for_world(visit, progress);
  if (!came) {
    const int code = fail(came.error(), progress);
    return interrupted_by() == 0 ? code : 128 + interrupted_by();
  }
  const RemoteStatus status = visit.status();
  progress.note(welcome_text(status));

  Stage stage;
  stage.scene = visit.world().scene;
  stage.machine = this_machine();
  options.default_out =
      folder_name(stage.scene.name, "scene") + "-" + folder_name(status.welcome.name, "peer");
  const Result<bool> set = set_stage(options, headless, stage);
  if (!set) return fail(set.error());
  // Somebody else's world runs for as long as they like.
  if (options.seconds <= 0.0) stage.seconds = std::numeric_limits<double>::infinity();

  RemoteRunOptions run_options;
  run_options.devices = options.devices;
  run_options.coupling = options.coupling == "spring" ? Coupling::kSpring : Coupling::kReplica;
  run_options.has_window = !headless;
  run_options.controllers = options.controllers;
  run_options.host = remote.address;
  run_options.begin_ns = begin_ns;
  run_options.tell = [&progress](const std::string& text) { progress.note(text); };
  Result<std::unique_ptr<LiveRun>> run = RemoteRun::create(stage, visit, run_options);
  if (!run) return fail(run.error());

  const MakeRun make_run = [&run]() -> Result<std::unique_ptr<LiveRun>> { return std::move(run.value()); };
  const int code = show_run(stage, make_run, options, headless, headset.get(), progress);
  const RemoteStatus last = visit.status();
  return last.error && code == kExitOk ? fail(*last.error) : code;
}

void add(CLI::App& app, VerbRun& chosen, bool watch) {
  CLI::App* verb = watch ? app.add_subcommand("watch", "Look on at somebody's world")
                         : app.add_subcommand("join", "Take hold of something in somebody's world");
  auto o = std::make_shared<JoinOptions>();
  o->watch = watch;
  verb->add_option(
      "LINK", o->link,
      "What the host printed: slosh://… (asked for); - reads it from standard input, @FILE from a file");
  verb->add_option("--link-file", o->link_file, "A file that holds the link, or what `host --links` wrote");
  verb->add_option("--name", o->name, "How the others see you (the host chooses)");
  if (!watch) {
    verb->add_option("--grip", o->grips, "A grip by name or number, again for more (the first free one)")
        ->allow_extra_args(false);
    verb->add_option("--device", o->devices,
                     "script, mouse, xr-left, xr-right, replay:FILE, spacemouse, gamepad, falcon, "
                     "plugin:FILE or operator; "
                     "one for all your hands, "
                     "or one each, in order")
        ->allow_extra_args(false);
    verb->add_option("--coupling", o->coupling,
                     "What a device that is felt is coupled to: replica, this site's own copy of what it "
                     "holds, steady over "
                     "any distance; or spring, the host's as it comes, for links below some 20 ms")
        ->check(CLI::IsMember({"replica", "spring"}))
        ->capture_default_str();
    add_guide_option(*verb, *o);
  }
  add_seconds_option(*verb, o->seconds, 0.01, "Simulated seconds to stay (until the host ends)");
  add_out_options(*verb, *o,
                  "Folder for the results (headless: out/<scene>-<name>, numbered; a window: none)");
  add_show_options(*verb, *o, true);
  add_headset_options(*verb, *o, !watch);
  verb->add_option("--key", o->key, "File with your key, made on first use (one for each person)");
  verb->footer(std::string(kFiles) + (watch ? kWatchFiles : kJoinFiles) +
               console_help(watch ? Console::kWatch : Console::kPeer) + (watch ? kWatchEnd : kJoinEnd));
  verb->callback([&chosen, o] { chosen = [o] { return join(*o); }; });
}

}  // namespace

void add_join(CLI::App& app, VerbRun& chosen) {
  add(app, chosen, false);
}

void add_watch(CLI::App& app, VerbRun& chosen) {
  add(app, chosen, true);
}

}  // namespace slosh
