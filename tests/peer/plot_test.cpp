#include "peer/output/plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>

#include "net/text/clean.h"
#include "peer/output/child_process.h"
#include "peer/output/recorder.h"
#include "peer/view/palette.h"
#include "render/image.h"

namespace slosh {
namespace {

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::path(::testing::TempDir()) / ("plot_test_" + name);
}

/// As a script of gnuplot's has text.
std::string in_octal(const std::string& text) {
  std::string out;
  for (const char c : text) {
    char octal[8];
    std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned char>(c));
    out += octal;
  }
  return out;
}

std::string in_xml(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

/// What gnuplot draws by a script of ours, as text in place of pixels.
std::string drawn_as_svg(std::string script) {
  std::signal(SIGPIPE, SIG_IGN);
  const std::size_t at = script.find("pngcairo");
  EXPECT_NE(at, std::string::npos);
  script.replace(at, script.find(" size", at) - at, "svg");
  Result<std::unique_ptr<ChildProcess>> gnuplot = ChildProcess::start({"gnuplot", "--default-settings", "-"});
  EXPECT_TRUE(gnuplot);
  gnuplot.value()->write(script.data(), script.size());
  const Result<bool> drawn = gnuplot.value()->finish();
  EXPECT_TRUE(drawn) << drawn.error().text();
  return gnuplot.value()->output();
}

PlotSheet sheet_of(std::vector<std::string> names, std::string title,
                   std::vector<std::string> parameters = {}) {
  PlotSheet sheet;
  sheet.names = std::move(names);
  sheet.title = std::move(title);
  sheet.parameters = std::move(parameters);
  return sheet;
}

void write_rows(const std::filesystem::path& file, int rows) {
  std::ofstream out(file);
  out << kWrenchesHeader << '\n';
  for (int i = 0; i < rows; ++i) {
    const double t = 0.01 * i;
    out << t << ",0," << 0.1 * std::sin(t) << ",-10,0,0,0,0.2\n";
    out << t << ",1,0," << -10 - 3 * std::sin(t) << ",0,0.1,0,0\n";
  }
}

TEST(ReadWrenches, SortsRowsByDevice) {
  const std::filesystem::path file = temporary("sort.csv");
  write_rows(file, 50);
  const Result<std::vector<WrenchSeries>> series = read_wrenches(file);
  ASSERT_TRUE(series) << series.error().text();
  ASSERT_EQ(series.value().size(), 2u);
  EXPECT_EQ(series.value()[0].time.size(), 50u);
  EXPECT_EQ(series.value()[1].on_hand[0].force.y, -10.0);
  EXPECT_EQ(series.value()[0].on_hand[7].torque.z, 0.2);
}

TEST(ReadWrenches, NamesTheLineThatIsCutShort) {
  const std::filesystem::path file = temporary("cut.csv");
  std::ofstream(file) << kWrenchesHeader << "\n0,0,1,2,3,4,5,6\n0.002,0,1,2";
  const Result<std::vector<WrenchSeries>> series = read_wrenches(file);
  ASSERT_FALSE(series);
  EXPECT_NE(series.error().where.find("line 3"), std::string::npos);
}

TEST(Thinned, KeepsEveryPeak) {
  std::vector<glm::dvec2> curve;
  for (int i = 0; i < 1000; ++i) curve.emplace_back(i, std::sin(0.01 * i));
  curve[377].y = 5.0;  // one sample, up and down
  curve[612].y = -4.0;
  const std::vector<glm::dvec2> thin = thinned(curve, 100);
  EXPECT_LE(thin.size(), 100u);
  EXPECT_GE(thin.size(), 90u);
  for (const std::size_t peak : {377u, 612u})
    EXPECT_NE(std::find(thin.begin(), thin.end(), curve[peak]), thin.end()) << peak;
  for (std::size_t i = 1; i < thin.size(); ++i) EXPECT_LT(thin[i - 1].x, thin[i].x) << "time rises";
  EXPECT_EQ(thinned(curve, 5000).size(), 1000u);
  EXPECT_TRUE(thinned({}, 100).empty());
}

TEST(PlotScript, ForceAboveTorqueBelowOneColourADevice) {
  const std::filesystem::path file = temporary("script.csv");
  write_rows(file, 100);
  const std::string script = plot_script(read_wrenches(file).value(), sheet_of({"left", "right"}, "a title"));
  EXPECT_LT(script.find("force on the hand, N"), script.find("torque on the hand, N·m"));
  EXPECT_NE(script.find(device_color(0).hex), std::string::npos);
  EXPECT_NE(script.find(device_color(1).hex), std::string::npos);
  EXPECT_NE(script.find(in_octal("left")), std::string::npos);
  EXPECT_NE(script.find("force along y, N"), std::string::npos) << "the force varies most along y";
  EXPECT_EQ(script.find("force along x, N"), std::string::npos);
  EXPECT_EQ(script.find("set output"), std::string::npos) << "a path may begin with | and be run";
}

/// What a stranger may call a grip or a scene, each of which would make `marker` if any of it were obeyed.
std::vector<std::string> hostile_names(const std::string& marker) {
  const std::string touch = "touch " + marker;
  return {"`" + touch + "`",
          "\"`" + touch + "`\"",
          "$(" + touch + ")",
          "\"; system(\"" + touch + "\"); x=\"",
          "'; system(\"" + touch + "\"); x='",
          "''; system(\"" + touch + "\"); x=''",
          "\\\"; system(\"" + touch + "\") #",
          "a\nsystem(\"" + touch + "\")\nb",
          "a\r!" + touch,
          "!" + touch,
          "|" + touch,
          "< " + touch,
          "@`" + touch + "`",
          "@GPVAL_TERM",
          "{/:Bold x}^2_3",
          "END_OF_DATA\nsystem(\"" + touch + "\")",
          "%s%n%d",
          "\xff\xfe" + touch,
          "\u009b31m",
          std::string(4096, '`') + touch + std::string(100, '`')};
}

TEST(PlotScript, WhatNamesAreMadeOfIsNeverParsed) {
  const std::filesystem::path marker = temporary("obeyed");
  std::filesystem::remove(marker);
  const std::filesystem::path file = temporary("hostile.csv");
  write_rows(file, 10);
  const std::vector<WrenchSeries> series = read_wrenches(file).value();
  for (const std::string& name : hostile_names(marker.string())) {
    const std::string script = plot_script(series, sheet_of({name, "other"}, name, {name}));
    EXPECT_EQ(script.find('`'), std::string::npos) << name;
    EXPECT_EQ(script.find("touch"), std::string::npos) << name;
    // The same script, but drawn as text that can be read.
    const std::string drawn = drawn_as_svg(script);
    EXPECT_FALSE(std::filesystem::exists(marker)) << name;
    const std::string first = clean_text(name, 12);
    EXPECT_NE(drawn.find(in_xml(first)), std::string::npos) << "the name is shown as it is: " << name;
    EXPECT_EQ(drawn.find(std::string(200, '`')), std::string::npos) << "and not longer than its place";
  }
}

/// What is wrong with the markup, empty when nothing is: an element that no drawing of gnuplot's has, or what
/// XML does not allow in text.
std::string strange_markup(const std::string& svg) {
  const std::vector<std::string> known{"?xml",    "svg",         "desc",   "title", "defs", "g",    "filter",
                                       "feFlood", "feComposite", "circle", "path",  "rect", "text", "use"};
  if (svg.find("]]>") != std::string::npos) return "]]>";
  for (std::size_t at = svg.find('<'); at != std::string::npos; at = svg.find('<', at + 1)) {
    const std::size_t begin = svg[at + 1] == '/' ? at + 2 : at + 1;
    const std::string element = svg.substr(begin, svg.find_first_of(" >/\n\t", begin) - begin);
    if (std::find(known.begin(), known.end(), element) == known.end()) return svg.substr(at, 40);
  }
  for (std::size_t at = svg.find('&'); at != std::string::npos; at = svg.find('&', at + 1)) {
    const std::string entity = svg.substr(at, svg.find(';', at) + 1 - at);
    if (entity != "&lt;" && entity != "&gt;" && entity != "&amp;") return svg.substr(at, 40);
  }
  return "";
}

TEST(PlotWrenches, NamesAreTextInEveryFormat) {
  std::signal(SIGPIPE, SIG_IGN);
  const std::filesystem::path marker = temporary("obeyed_markup");
  std::filesystem::remove(marker);
  const std::filesystem::path file = temporary("markup.csv");
  write_rows(file, 10);
  std::vector<std::string> names = hostile_names(marker.string());
  const std::size_t of_shells = names.size();
  for (const char* markup : {"<script>alert(1)</script>", "</text></svg><script>alert(1)</script>",
                             "]]><script/>", "&#60;script&#62;", "<!-- ", "\" onload=\"alert(1)", "<![CDATA[",
                             "<span foreground='red'>", "%PDF-1.7 endobj"})
    names.emplace_back(markup);
  for (const char* format : {"svg", "pdf", "png"}) {
    for (const std::size_t first : {std::size_t{0}, of_shells, of_shells + 2, of_shells + 6}) {
      PlotSheet sheet = sheet_of({names[first], names[first + 1]}, names[first + 2], names);
      sheet.format = format;
      const std::filesystem::path picture = temporary(std::string("markup.") + format);
      const Result<bool> drawn = plot_wrenches(file, sheet, picture);
      ASSERT_TRUE(drawn) << drawn.error().text();
      EXPECT_FALSE(std::filesystem::exists(marker)) << format;
      std::ifstream in(picture, std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(in), {}};
      EXPECT_GT(bytes.size(), 1000u) << format;
      if (std::string(format) != "svg") continue;
      EXPECT_EQ(strange_markup(bytes), "");
      EXPECT_NE(bytes.find("&lt;script>alert(1)&lt;/script>"), std::string::npos) << "it is shown as it is";
      EXPECT_NE(bytes.find("]]&gt;"), std::string::npos);
    }
  }
}

TEST(PlotWrenches, GnuplotDrawsBothColours) {
  std::signal(SIGPIPE, SIG_IGN);
  const std::filesystem::path file = temporary("draw.csv");
  const std::filesystem::path png = temporary("draw.png");
  write_rows(file, 300);
  const Result<bool> drawn = plot_wrenches(file, sheet_of({"left", "right"}, "test"), png);
  ASSERT_TRUE(drawn) << drawn.error().text();
  const Result<Image> image = read_png(png);
  ASSERT_TRUE(image) << image.error().text();
  EXPECT_EQ(image.value().width, 1200);
  int red = 0;
  int blue = 0;
  for (std::size_t i = 0; i + 3 < image.value().rgba.size(); i += 4) {
    const std::uint8_t* p = &image.value().rgba[i];
    red += p[0] > 180 && p[1] < 90 && p[2] < 90;
    blue += p[0] < 70 && p[1] < 130 && p[2] > 150;
  }
  EXPECT_GT(red, 1000);
  EXPECT_GT(blue, 1000);
}

TEST(PlotWrenches, EachPanelIsFittedToItsOwnData) {
  // Both hands carry −10 N to −13 N along y: an axis with 0 or a magnitude's +10 on it would leave them a
  // third.
  const std::filesystem::path file = temporary("fitted.csv");
  write_rows(file, 300);
  PlotSheet sheet = sheet_of({"left", "right"}, "test", {"spacing 8 mm"});
  sheet.quantities = {"fy"};
  const std::string drawn = drawn_as_svg(plot_script(read_wrenches(file).value(), sheet));
  EXPECT_NE(drawn.find("-10"), std::string::npos);
  EXPECT_NE(drawn.find("-13"), std::string::npos);
  EXPECT_EQ(drawn.find(">0<"), drawn.rfind(">0<")) << "0 is on the axis of time alone";
  EXPECT_NE(drawn.find("spacing 8 mm"), std::string::npos) << "the sheet says what was simulated";
}

TEST(PlotWrenches, CurvesThatCoincideAreBothSeen) {
  const std::filesystem::path file = temporary("coincide.csv");
  const std::filesystem::path png = temporary("coincide.png");
  std::ofstream out(file);
  out << kWrenchesHeader << '\n';
  for (int i = 0; i < 300; ++i) {
    for (int device = 0; device < 2; ++device)
      out << 0.01 * i << ',' << device << ",0," << std::sin(0.02 * i) << ",0,0,0,0\n";
  }
  out.close();
  PlotSheet sheet = sheet_of({"left", "right"}, "test");
  sheet.quantities = {"fy"};
  const Result<bool> drawn = plot_wrenches(file, sheet, png);
  ASSERT_TRUE(drawn) << drawn.error().text();
  const Result<Image> image = read_png(png);
  ASSERT_TRUE(image) << image.error().text();
  // In the panel, below the legend.
  int red = 0;
  int blue = 0;
  for (int y = 70; y < image.value().height; ++y) {
    for (int x = 0; x < image.value().width; ++x) {
      const std::uint8_t* p =
          &image.value().rgba[std::size_t{4} * (static_cast<std::size_t>(y) * image.value().width + x)];
      red += p[0] > 180 && p[1] < 90 && p[2] < 90;
      blue += p[0] < 70 && p[1] < 130 && p[2] > 150;
    }
  }
  EXPECT_GT(red, 300);
  EXPECT_GT(blue, 300);
}

TEST(PlotWrenches, DrawsWhatAPaperWouldTake) {
  const std::filesystem::path file = temporary("vector.csv");
  write_rows(file, 100);
  const auto begins = [&](const std::string& format, const std::string& magic) {
    PlotSheet sheet = sheet_of({"left", "right"}, "test");
    sheet.format = format;
    const std::filesystem::path picture = temporary("vector." + format);
    const Result<bool> drawn = plot_wrenches(file, sheet, picture);
    ASSERT_TRUE(drawn) << drawn.error().text();
    std::ifstream in(picture, std::ios::binary);
    std::string head(400, '\0');
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    EXPECT_NE(head.find(magic), std::string::npos) << format;
  };
  begins("svg", "<svg");
  begins("pdf", "%PDF-");
}

TEST(PlotWrenches, NothingRecordedIsNothingToPlot) {
  const std::filesystem::path file = temporary("nothing.csv");
  std::ofstream(file) << kWrenchesHeader << '\n';
  const Result<bool> drawn = plot_wrenches(file, {}, temporary("nothing.png"));
  ASSERT_TRUE(drawn) << drawn.error().text();
  EXPECT_FALSE(drawn.value());
  EXPECT_FALSE(std::filesystem::exists(temporary("nothing.png")));
}

}  // namespace
}  // namespace slosh
