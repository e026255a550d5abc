#include "peer/output/gnuplot.h"

#include <cstdio>

#include "peer/output/child_process.h"
#include "peer/output/whole_file.h"
#include "sim/math/format.h"

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

std::string gnuplot_terminal(const std::string& kind, int width, int height, int font_points) {
  const std::string font =
      format(" noenhanced font \"DejaVu Sans,%d\" background rgb \"white\"\n", font_points);
  if (kind == "pdf")
    return format("set terminal pdfcairo size %.3f,%.3f", width / 72.0, height / 72.0) + font;
  return format("set terminal %s size %d,%d", kind == "svg" ? "svg" : "pngcairo", width, height) + font;
}

namespace {

/// Gnuplot's SVG leaves ">" as it is, and "]]>" may not stand in XML's text: a name that holds it would make
/// a picture that no browser opens. Nothing else in its files has these three in a row.
std::string well_formed(std::string svg) {
  for (std::size_t at = svg.find("]]>"); at != std::string::npos; at = svg.find("]]>", at))
    svg.replace(at, 3, "]]&gt;");
  return svg;
}

}  // namespace

Result<bool> draw(const std::string& script, const std::filesystem::path& file) {
  Result<std::unique_ptr<ChildProcess>> gnuplot = ChildProcess::start({"gnuplot", "--default-settings", "-"});
  if (!gnuplot) return gnuplot.error();
  gnuplot.value()->write(script.data(), script.size());
  const Result<bool> drawn = gnuplot.value()->finish();
  if (!drawn) return drawn.error();
  const std::string& picture = gnuplot.value()->output();
  return write_whole(file, file.extension() == ".svg" ? well_formed(picture) : picture);
}

}  // namespace slosh
