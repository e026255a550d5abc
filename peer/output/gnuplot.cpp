#include "peer/output/gnuplot.h"

#include <cstdio>

#include "peer/output/child_process.h"
#include "peer/output/whole_file.h"

namespace slosh {

std::string gnuplot_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    char octal[8];
    std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned>(static_cast<unsigned char>(c)));
    out += octal;
  }
  return out + "\"";
}

Result<bool> draw(const std::string& script, const std::filesystem::path& file) {
  Result<std::unique_ptr<ChildProcess>> gnuplot = ChildProcess::start({"gnuplot", "--default-settings", "-"});
  if (!gnuplot) return gnuplot.error();
  gnuplot.value()->write(script.data(), script.size());
  const Result<bool> drawn = gnuplot.value()->finish();
  if (!drawn) return drawn.error();
  return write_whole(file, gnuplot.value()->output());
}

}  // namespace slosh
