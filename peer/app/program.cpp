#include "peer/app/program.h"

#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "net/text/clean.h"
#include "net/text/nearest.h"
#include "peer/app/uncaught.h"
#include "peer/app/verbs.h"
#include "peer/install/version.h"
#include "peer/remote/link_source.h"
#include "peer/settings/settings.h"

namespace slosh {
namespace {

constexpr std::size_t kHelpLine = 110;  // bytes, as the launcher's own help

/// `text` in lines of at most `width` bytes where its words allow; breaks that it has are not kept.
std::string wrapped_words(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string all;
  std::size_t used = 0;
  for (std::string word; words >> word;) {
    if (used > 0 && used + 1 + word.size() > width) {
      all += '\n';
      used = 0;
    } else if (used > 0) {
      all += ' ';
      ++used;
    }
    all += word;
    used += word.size();
  }
  return all;
}

/// CLI11's own --help, its column of explanations in lines of a width that terminals have.
class WrappedHelp : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped_words(CLI::Formatter::make_option_desc(option),
                         kHelpLine - std::min(kHelpLine / 2, get_column_width()));
  }
};

/// Options of `app` whose names are near to words that it did not know: "--headless, --seconds".
std::string options_near(const CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back(name);
  std::string all;
  for (const std::string& word : words) {
    if (!word.starts_with("--")) continue;
    const std::string near = nearest_word(word.substr(2, word.find('=') - 2), known);
    if (!near.empty()) all += (all.empty() ? "--" : ", --") + near;
  }
  return all;
}

/// Of words that `verb` did not know, what other verbs take them: "--headless is an option of play, join and
/// watch. ".
std::string options_elsewhere(const CLI::App& app, const CLI::App& verb,
                              const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) {
    if (!word.starts_with("--")) continue;
    const std::string name = word.substr(0, word.find('='));
    std::string verbs;
    std::size_t count = 0;
    for (const CLI::App* other : app.get_subcommands({})) {
      if (other == &verb || other->get_option_no_throw(name) == nullptr) continue;
      verbs += (count++ == 0 ? "" : ", ") + other->get_name();
    }
    if (const std::size_t last = verbs.rfind(", "); last != std::string::npos)
      verbs.replace(last, 2, " and ");
    if (count > 0) all += clean_text(name, kMaxTextBytes) + " is an option of " + verbs + ". ";
  }
  return all;
}

int no_such_verb(const CLI::App& app, const char* word) {
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
  const std::string shown = clean_text(word, kMaxTextBytes);
  // Those that the launcher of a source tree does by itself.
  constexpr std::array kLaunchers{"test", "bench", "python", "package", "format"};
  if (std::find(kLaunchers.begin(), kLaunchers.end(), shown) != kLaunchers.end())
    std::fprintf(
        stderr,
        "slosh: %s is done by the launcher ./slosh in the sources, not by the program. See `slosh --help`.\n",
        shown.c_str());
  else
    std::fprintf(stderr, "slosh: there is no verb '%s'. %sSee `slosh --help`.\n", shown.c_str(),
                 did_you_mean(shown, verbs).c_str());
  return kExitUsage;
}

/// Says what is wrong with the words behind a verb, or behind one of its own ("report error").
int wrong_words(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* at = &app;
  std::string verb;
  for (; !at->get_subcommands().empty(); at = at->get_subcommands().front())
    verb += at->get_subcommands().front()->get_name() + " ";
  std::string what = clean_lines(error.what(), kMaxTextBytes);
  std::string near;
  const std::vector<std::string> words = app.remaining(true);
  std::vector<std::string> below;
  for (const CLI::App* sub : at->get_subcommands({})) below.push_back(sub->get_name());
  if (at != &app && !below.empty() && !words.empty() && !words[0].starts_with('-')) {
    const std::string shown = clean_text(words[0], kMaxTextBytes);
    what = verb + "knows no '" + shown + "'";
    near = did_you_mean(shown, below);
  } else if (near = options_elsewhere(app, *at, words); near.empty()) {
    const std::string alike = options_near(*at, words);
    if (!alike.empty()) near = "Did you mean " + alike + "? ";
  }
  std::fprintf(stderr, "slosh: %s. %sSee `slosh %s--help`.\n", what.c_str(), near.c_str(), verb.c_str());
  return kExitUsage;
}

/// What is printed may be what was asked for: where it could not be written the run has failed. Who reads no
/// further (| head) has what they want.
int with_all_printed(int code) {
  const bool before = std::ferror(stdout) != 0;
  errno = 0;
  if (std::fflush(stdout) == 0 && !before) return code;
  struct stat out{};
  if (fstat(STDOUT_FILENO, &out) != 0 || S_ISFIFO(out.st_mode) || S_ISSOCK(out.st_mode)) return code;
  std::fprintf(
      stderr,
      "slosh: standard output: not all could be written%s%s. Free some space, or write it elsewhere.\n",
      errno != 0 ? ": " : "", errno != 0 ? std::strerror(errno) : "");
  return code == kExitOk ? kExitFailed : code;
}

/// A file whose name begins with a dash is a file all the same: "-cup.glb" is read as "./-cup.glb".
bool is_scene_file(const std::string& word) {
  if (!word.starts_with('-') || word.find('=') != std::string::npos) return false;
  std::string end = std::filesystem::path(word).extension().string();
  for (char& c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::error_code code;
  return (end == ".glb" || end == ".gltf") && std::filesystem::exists(word, code);
}

int run(std::span<const AddVerb> verbs, int argc, char** shown) {
  // Before anything takes time: everybody on this machine can read what a program was started with.
  std::vector<std::string> words(shown, shown + argc);
  hide_links(argc, shown);
  std::vector<char*> argv;
  for (std::string& word : words) {
    if (!argv.empty() && is_scene_file(word)) word.insert(0, "./");
    argv.push_back(word.data());
  }
  argv.push_back(nullptr);
  CLI::App app("Touch simulated fluids together.", "slosh");
  app.set_version_flag("--version", version_text);
  app.require_subcommand(1);
  app.formatter(std::make_shared<WrappedHelp>());
  app.get_formatter()->column_width(34);
  VerbRun chosen;
  const bool names_a_verb = argc > 1 && argv[1][0] != '-';
  for (const AddVerb add : verbs) add(app, chosen);
  SettingsFile settings = read_settings(settings_path());
  add_settings(app, settings, chosen);
  put_in_force(settings, app);
  if (names_a_verb &&
      app.get_subcommands([&](const CLI::App* sub) { return sub->check_name(argv[1]); }).empty())
    return no_such_verb(app, argv[1]);
  try {
    app.parse(argc, argv.data());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return with_all_printed(app.exit(error));  // --help, --version
    return wrong_words(app, error);
  }
  // Wrong settings are said before anything is begun, and nothing is begun with half of them.
  if (!settings.errors.empty() && !app.got_subcommand("settings")) {
    for (const Error& error : settings.errors) fail(error);
    std::fprintf(
        stderr,
        "slosh: nothing was begun. `slosh settings` shows them all; SLOSH_SETTINGS=none goes without.\n");
    return kExitUsage;
  }
  return with_all_printed(chosen());
}

}  // namespace

int run_program(std::span<const AddVerb> verbs, int argc, char** argv) {
  say_uncaught_cleanly();
  // A child (ffmpeg) that dies must be an error to report, not the end of this program; so must a file that
  // may grow no further (ulimit -f).
  for (const int signal_number : {SIGPIPE, SIGXFSZ}) std::signal(signal_number, SIG_IGN);
  try {
    return run(verbs, argc, argv);
  } catch (const std::exception& error) {
    return fail_uncaught(error);
  }
}

}  // namespace slosh
