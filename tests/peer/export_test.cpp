// Surfaces made of particles, and what is refused before it begins.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "peer/output/export/exporter.h"
#include "peer/output/export/fluid_surface.h"
#include "peer/output/export/particle_files.h"
#include "peer/output/export/surface_files.h"
#include "tests/support/places.h"

namespace slosh {
namespace {

constexpr double kSpacing = 0.01;

ExportedFluids fluids(std::size_t count) {
  ExportedFluids out;
  out.spacing = kSpacing;
  for (std::size_t i = 0; i < count; ++i) {
    out.names.push_back(i == 0 ? "water" : "oil");
    out.colors.emplace_back(0.1f, 0.3f, 0.6f);
  }
  return out;
}

/// A particle with a velocity and a pressure that follow from its place.
void add(ParticleFrame& frame, const glm::vec3& p, std::uint8_t fluid) {
  frame.positions.push_back(p);
  frame.velocities.emplace_back(p.y, 2.0f * p.z, 3.0f * p.x);
  frame.pressures.push_back(1000.0f * p.y);
  frame.ids.push_back(static_cast<std::uint32_t>(frame.ids.size()));
  frame.fluids.push_back(fluid);
}

/// A lattice, each particle off its place by up to `jitter` spacings, where `inside` says so.
template <class Inside>
void fill(ParticleFrame& frame, int half, float jitter, std::uint8_t fluid, const glm::vec3& middle,
          Inside inside) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> off(-jitter, jitter);
  for (int z = -half; z <= half; ++z)
    for (int y = -half; y <= half; ++y)
      for (int x = -half; x <= half; ++x)
        if (inside(x, y, z))
          add(frame,
              middle + static_cast<float>(kSpacing) * glm::vec3(static_cast<float>(x) + off(random),
                                                                static_cast<float>(y) + off(random),
                                                                static_cast<float>(z) + off(random)),
              fluid);
}

/// Every edge has two triangles, which run along it in opposite ways.
void expect_closed(const FluidSurface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const glm::uvec3& t : surface.triangles)
    for (int i = 0; i < 3; ++i) edges[{t[i], t[(i + 1) % 3]}] += 1;
  std::size_t wrong = 0;
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    wrong += count != 1 || back == edges.end() || back->second != 1 ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0u) << "of " << edges.size() << " directed edges";
}

double enclosed(const FluidSurface& surface) {
  double six = 0.0;
  for (const glm::uvec3& t : surface.triangles) {
    const glm::dvec3 a(surface.positions[t.x]), b(surface.positions[t.y]), c(surface.positions[t.z]);
    six += glm::dot(a, glm::cross(b, c));
  }
  return six / 6.0;
}

struct Shape {
  const char* name;
  int half;
  float jitter;
  bool (*inside)(int, int, int);
  double bound;
};

class SurfaceOf : public ::testing::TestWithParam<Shape> {};

TEST_P(SurfaceOf, EnclosesTheParticlesVolumeAndIsClosed) {
  const Shape& shape = GetParam();
  ParticleFrame frame;
  fill(frame, shape.half, shape.jitter, 0, {0.3f, 0.1f, -0.2f}, shape.inside);
  const SurfaceFrame made = make_surfaces(frame, fluids(1), false, 1);
  ASSERT_EQ(made.fluids.size(), 1u);
  const FluidSurface& surface = made.fluids[0];
  const double volume = static_cast<double>(frame.size()) * kSpacing * kSpacing * kSpacing;
  EXPECT_DOUBLE_EQ(surface.particle_volume, volume);
  EXPECT_NEAR(enclosed(surface) / volume, 1.0, shape.bound);
  EXPECT_NEAR(surface.volume / enclosed(surface), 1.0, 1e-3);
  expect_closed(surface);
}

INSTANTIATE_TEST_SUITE_P(
    shapes, SurfaceOf,
    ::testing::Values(
        Shape{"box", 7, 0.0f, [](int, int, int) { return true; }, kSurfaceVolumeBound},
        Shape{"shaken_box", 7, 0.3f, [](int, int, int) { return true; }, kSurfaceVolumeBound},
        Shape{"ball", 7, 0.25f, [](int x, int y, int z) { return x * x + y * y + z * z <= 49; },
              kSurfaceVolumeBound},
        Shape{"sheet_of_two", 12, 0.2f, [](int, int y, int) { return y == 0 || y == 1; },
              kSurfaceVolumeBound},
        // A pool and drops over it.
        Shape{"splash", 8, 0.1f,
              [](int x, int y, int z) { return y < 0 || (x % 4 == 0 && y % 4 == 0 && z % 4 == 0); },
              kSurfaceVolumeBound},
        Shape{"drops", 8, 0.0f, [](int x, int y, int z) { return x % 4 == 0 && y % 4 == 0 && z % 4 == 0; },
              kSurfaceDropBound}),
    [](const auto& shape) { return shape.param.name; });

TEST(Surface, HasTheVelocityAndPressureOfTheFluidThere) {
  ParticleFrame frame;
  fill(frame, 6, 0.0f, 0, {0.0f, 0.2f, 0.0f}, [](int, int, int) { return true; });
  const FluidSurface surface = make_surfaces(frame, fluids(1), false, 1).fluids[0];
  ASSERT_GT(surface.positions.size(), 500u);
  glm::vec3 least(1e9f), most(-1e9f);
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const glm::vec3& p = surface.positions[i];
    // A linear field, weighed on one side of the surface alone: a spacing off at most.
    EXPECT_NEAR(surface.velocities[i].x, p.y, kSpacing);
    EXPECT_NEAR(surface.velocities[i].y, 2.0f * p.z, 2.0 * kSpacing);
    EXPECT_NEAR(surface.velocities[i].z, 3.0f * p.x, 3.0 * kSpacing);
    EXPECT_NEAR(surface.pressures[i], 1000.0f * p.y, 1000.0 * kSpacing);
    EXPECT_NEAR(glm::length(surface.normals[i]), 1.0f, 1e-4f);
    EXPECT_GT(glm::dot(surface.normals[i], p - glm::vec3(0.0f, 0.2f, 0.0f)), 0.0f) << "out of the fluid";
    least = glm::min(least, p);
    most = glm::max(most, p);
  }
  // Half a spacing beyond the outermost particles, y up still.
  EXPECT_NEAR(most.y, 0.2 + 6.5 * kSpacing, 0.25 * kSpacing);
  EXPECT_NEAR(least.y, 0.2 - 6.5 * kSpacing, 0.25 * kSpacing);
  EXPECT_NEAR(most.x, 6.5 * kSpacing, 0.25 * kSpacing);
}

TEST(Surface, EachFluidHasItsOwn) {
  ParticleFrame frame;
  fill(frame, 5, 0.0f, 0, {0.0f, 0.0f, 0.0f}, [](int, int y, int) { return y < 0; });
  fill(frame, 5, 0.0f, 1, {0.0f, 0.0f, 0.0f}, [](int, int y, int) { return y >= 0; });
  const SurfaceFrame made = make_surfaces(frame, fluids(3), true, 1);
  ASSERT_EQ(made.fluids.size(), 3u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(made.fluids[i].fluid, i);
    EXPECT_NEAR(made.fluids[i].volume / made.fluids[i].particle_volume, 1.0, kSurfaceVolumeBound);
    expect_closed(made.fluids[i]);
  }
  EXPECT_TRUE(made.fluids[2].positions.empty()) << "none of it is there";
  for (const char* grid : {"surface_water", "velocity_water", "pressure_water", "surface_oil"})
    EXPECT_NE(made.vdb.find(grid), std::string::npos) << grid;
}

TEST(Surface, OfNoParticlesIsEmpty) {
  const SurfaceFrame made = make_surfaces({}, fluids(1), true, 1);
  ASSERT_EQ(made.fluids.size(), 1u);
  EXPECT_TRUE(made.fluids[0].positions.empty());
  EXPECT_FALSE(made.vdb.empty()) << "a file without grids";
}

/// What a stranger may call a fluid, as the scene's reader leaves it.
TEST(Exports, NamesAreTextInEveryFile) {
  const std::vector<std::string> names{"--><script>alert(1)</script>",
                                       "</VTKFile>",
                                       "a-- --!>-",
                                       "\"/><x y=\"",
                                       "end_header",
                                       "../../etc/passwd",
                                       std::string(400, '`')};
  ExportedFluids named;
  named.spacing = kSpacing;
  ParticleFrame frame;
  for (std::size_t i = 0; i < names.size(); ++i) {
    named.names.push_back(names[i]);
    named.colors.emplace_back(0.5f);
    fill(frame, 2, 0.0f, static_cast<std::uint8_t>(i), {1.0f * static_cast<float>(i), 0.0f, 0.0f},
         [](int, int, int) { return true; });
  }
  const std::string ply = particles_as_ply(frame, named);
  const std::size_t end = ply.find("\nend_header\n");
  ASSERT_NE(end, std::string::npos);
  std::size_t comments = 0, lines = 0;
  std::istringstream head(ply.substr(0, end));
  for (std::string line; std::getline(head, line); ++lines)
    comments += line.rfind("comment ", 0) == 0 ? 1 : 0;
  EXPECT_EQ(comments, 4 + names.size());
  EXPECT_EQ(lines, comments + 2 + 1 + 9) << "ply, format, the element and its properties";
  EXPECT_EQ(ply.size() - (end + 12), frame.size() * 33) << "what follows is the particles and nothing else";

  const std::string vtu = particles_as_vtu(frame, named);
  const std::size_t comment = vtu.find("<!--");
  const std::size_t closed = vtu.find("-->", comment);
  ASSERT_NE(closed, std::string::npos);
  EXPECT_EQ(vtu.find("--", comment + 4), closed) << "XML allows no -- within a comment";
  EXPECT_EQ(vtu.find("<VTKFile", closed), closed + 4) << "and it ends where ours does";
  EXPECT_EQ(vtu.find("script", closed), std::string::npos);
  EXPECT_EQ(vtu.find("</VTKFile>", closed), vtu.size() - 11);

  const SurfaceFrame made = make_surfaces(frame, named, true, 1);
  const std::string glb = surface_as_glb(made, frame, named);
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, glb.data() + 12, sizeof(json_bytes));
  const nlohmann::json json = nlohmann::json::parse(glb.substr(20, json_bytes));
  ASSERT_EQ(json["nodes"].size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(json["nodes"][i]["name"], names[i]);
  for (const nlohmann::json& buffer : json["buffers"]) EXPECT_FALSE(buffer.contains("uri"));
}

TEST(Exports, AreNamedAndRefusedByName) {
  const Result<std::vector<ExportKind>> both = parse_exports({"surface:vdb", "particles:ply", "surface:vdb"});
  ASSERT_TRUE(both);
  ASSERT_EQ(both.value().size(), 2u) << "each once";
  EXPECT_EQ(both.value()[0], ExportKind::kSurfaceVdb);
  EXPECT_STREQ(stem(both.value()[0]), "surface");
  EXPECT_STREQ(extension(both.value()[0]), "vdb");
  EXPECT_STREQ(extension(ExportKind::kParticlesVtu), "vtu");
  const Result<std::vector<ExportKind>> wrong = parse_exports({"surfaces:vbd"});
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().text().find("Did you mean surface:vdb?"), std::string::npos)
      << wrong.error().text();
  EXPECT_FALSE(parse_exports({"particles"}));
  EXPECT_FALSE(parse_exports({""}));
}

class ExporterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        test::build_dir() / "export_test" / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ParticleFrame frame_at(double time) {
    ParticleFrame frame;
    frame.time = time;
    add(frame, {0.1f, 0.2f, 0.3f}, 0);
    return frame;
  }
  std::string text(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }
  std::filesystem::path folder_;
};

TEST_F(ExporterTest, NumbersFramesByTheirTime) {
  ExportOptions options;
  options.kinds = {ExportKind::kParticlesVtu};
  options.rate = 100.0;
  options.waits = true;
  Result<std::unique_ptr<Exporter>> made = Exporter::create(fluids(1), options, folder_);
  ASSERT_TRUE(made) << made.error().text();
  Exporter& exporter = *made.value();
  std::size_t taken = 0;
  for (int step = 0; step <= 10; ++step) {
    const double time = 0.003 * step;
    if (!exporter.due(time)) continue;
    exporter.add(frame_at(time));
    ++taken;
  }
  // A step that is longer than a frame: its number is missing.
  ASSERT_TRUE(exporter.due(0.0554));
  exporter.add(frame_at(0.0554));
  exporter.stop();
  EXPECT_EQ(taken, 4u);
  EXPECT_EQ(exporter.report().frames, 5u);
  EXPECT_EQ(exporter.problem(), "");
  EXPECT_EQ(text(folder_ / "frames/frames.csv"),
            std::string(kFramesHeader) +
                "\n0,0,1,1e-06,\n1,0.012,1,1e-06,\n2,0.021,1,1e-06,\n3,0.03,1,1e-06,\n5,0.0554,1,1e-06,\n");
  const std::string index = text(folder_ / "frames/particles.pvd");
  EXPECT_NE(index.find("<DataSet timestep=\"0.0554\" part=\"0\" file=\"particles_00005.vtu\"/>"),
            std::string::npos);
}

TEST_F(ExporterTest, AFileThatCannotBeWrittenEndsItWithWords) {
  ExportOptions options;
  options.kinds = {ExportKind::kParticlesPly};
  options.waits = true;
  Result<std::unique_ptr<Exporter>> made = Exporter::create(fluids(1), options, folder_);
  ASSERT_TRUE(made) << made.error().text();
  Exporter& exporter = *made.value();
  // In the place of a file that is to be renamed into it.
  std::filesystem::create_directories(folder_ / "frames/particles_00001.ply/in_the_way");
  for (int i = 0; i < 4; ++i) exporter.add(frame_at(i / 30.0 + 1e-6));
  exporter.stop();
  EXPECT_EQ(exporter.report().frames, 1u);
  EXPECT_NE(exporter.problem().find("the frames for export have ended: "), std::string::npos)
      << exporter.problem();
  EXPECT_NE(exporter.problem().find("particles_00001.ply"), std::string::npos) << exporter.problem();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "frames/particles_00000.ply"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "frames/particles_00002.ply"));
}

}  // namespace
}  // namespace slosh
