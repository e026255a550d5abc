#include "display.h"

#include <signal.h>

#include <cctype>

#include "tests/support/comes.h"

namespace slosh::test {

bool installed(const std::string& program) {
  return Process({"which", program}, test_folder() / "which").wait().code == 0;
}

Display::Display(const std::filesystem::path& folder)
    : folder_(folder),
      server_({"Xvfb", "-displayfd", "1", "-screen", "0", "1024x768x24", "-nolisten", "tcp"},
              folder / "xvfb") {
  comes([&] {
    return !server_.running() || read_text(folder_ / "xvfb/stdout.txt").find('\n') != std::string::npos;
  });
  name_ = std::string(":").append(read_text(folder_ / "xvfb/stdout.txt"));
  while (!name_.empty() && std::isspace(static_cast<unsigned char>(name_.back()))) name_.pop_back();
}

Display::~Display() {
  server_.signal(SIGTERM);
  server_.wait();
}

std::vector<std::string> Display::on(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), {"env", "DISPLAY=" + name_});
  return arguments;
}

std::string Display::act(std::vector<std::string> words) const {
  words.insert(words.begin(), "xdotool");
  return Process(on(words), folder_ / "xdotool").wait().out;
}

}  // namespace slosh::test
