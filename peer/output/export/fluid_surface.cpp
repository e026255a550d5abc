#include "peer/output/export/fluid_surface.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Filter.h>
#include <openvdb/tools/LevelSetRebuild.h>
#include <openvdb/tools/ParticlesToLevelSet.h>
#include <openvdb/tools/PointIndexGrid.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <sstream>

#include "peer/output/export/export_options.h"

namespace slosh {

bool can_make_surfaces() {
  return true;
}

namespace {

namespace vdb = openvdb;

constexpr double kBand = 3.0;       // voxels on each side of a level set, as every tool expects
constexpr double kInnerBand = 6.0;  // voxels: the surface is set back by at most two of them
constexpr double kMinSetBack = -0.1,
                 kMaxSetBack = 0.6;  // spacings; a ball of 1 spacing set back by 0.38 has its own volume
constexpr double kUsualSetBack = 0.39;
constexpr double kCloseEnough = 5e-4;  // of the volume
constexpr int kMaxTries = 14;
constexpr double kReach = 1.5;  // spacings: whose velocity and pressure a place of the surface has

vdb::Vec3s to_vdb(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}
glm::vec3 from_vdb(const vdb::Vec3s& v) {
  return {v.x(), v.y(), v.z()};
}

/// The particles of one fluid, z up, as OpenVDB asks for them.
struct Cloud {
  using PosType = vdb::Vec3R;
  using value_type = vdb::Vec3s;
  std::vector<vdb::Vec3s> positions;
  std::vector<std::size_t> of_frame;  // their places in the frame

  std::size_t size() const { return positions.size(); }
  template <class Position>
  void getPos(std::size_t i, Position& out) const {
    out = Position(positions[i]);
  }
};

struct Polygons {
  std::vector<vdb::Vec3s> points;
  std::vector<vdb::Vec3I> triangles;
};

/// The surface at `level` (m, of the level set), triangles outward. Quadrilaterals are cut along their
/// shorter diagonal.
Polygons polygons_at(const vdb::FloatGrid& grid, double level) {
  Polygons out;
  std::vector<vdb::Vec4I> quads;
  vdb::tools::volumeToMesh(grid, out.points, out.triangles, quads, level, 0.0, true);
  for (vdb::Vec3I& t : out.triangles) std::swap(t[1], t[2]);
  for (const vdb::Vec4I& q : quads) {
    const auto length = [&](int a, int b) { return (out.points[q[a]] - out.points[q[b]]).lengthSqr(); };
    if (length(0, 2) <= length(1, 3)) {
      out.triangles.emplace_back(q[0], q[2], q[1]);
      out.triangles.emplace_back(q[0], q[3], q[2]);
    } else {
      out.triangles.emplace_back(q[0], q[3], q[1]);
      out.triangles.emplace_back(q[1], q[3], q[2]);
    }
  }
  return out;
}

double volume_of(const Polygons& mesh) {
  if (mesh.points.empty()) return 0.0;
  const vdb::Vec3d origin(mesh.points[0]);  // near, against cancellation
  double six = 0.0;
  for (const vdb::Vec3I& t : mesh.triangles) {
    const vdb::Vec3d a = vdb::Vec3d(mesh.points[t[0]]) - origin;
    const vdb::Vec3d b = vdb::Vec3d(mesh.points[t[1]]) - origin;
    const vdb::Vec3d c = vdb::Vec3d(mesh.points[t[2]]) - origin;
    six += a.dot(b.cross(c));
  }
  return six / 6.0;
}

/// The level at which the surface encloses `volume`, within what is sensible for balls of particles.
double level_of_volume(const vdb::FloatGrid& grid, double volume, double spacing) {
  double low = -kMaxSetBack * spacing;
  double high = -kMinSetBack * spacing;
  double level = -kUsualSetBack * spacing;
  for (int tries = 0; tries < kMaxTries; ++tries) {
    const double now = volume_of(polygons_at(grid, level));
    if (std::abs(now - volume) <= kCloseEnough * volume) break;
    (now > volume ? high : low) = level;
    level = 0.5 * (low + high);
  }
  return level;
}

/// What the particles around a place have, by weights that fall to 0 at kReach.
class Neighbourhood {
 public:
  Neighbourhood(const Cloud& cloud, const ParticleFrame& frame, double spacing)
      : cloud_(cloud),
        frame_(frame),
        reach_(kReach * spacing),
        transform_(vdb::math::Transform::createLinearTransform(spacing)),
        index_(vdb::tools::createPointIndexGrid<vdb::tools::PointIndexGrid>(cloud, *transform_)) {}

  struct Sample {
    vdb::Vec3s velocity{0.0f};  // z up
    float pressure = 0.0f;
  };

  class Reader {
   public:
    explicit Reader(const Neighbourhood& around)
        : around_(around), access_(around.index_->getConstAccessor()) {}

    Sample at(const vdb::Vec3d& place) {
      found_.worldSpaceSearchAndUpdate(place, around_.reach_, access_, around_.cloud_, *around_.transform_);
      Sample sum;
      double weights = 0.0;
      for (; found_; ++found_) {
        const vdb::Vec3d away = vdb::Vec3d(around_.cloud_.positions[*found_]) - place;
        const double left = std::max(0.0, 1.0 - away.lengthSqr() / (around_.reach_ * around_.reach_));
        const double weight = left * left * left + 1e-9;
        const std::size_t i = around_.cloud_.of_frame[*found_];
        sum.velocity += static_cast<float>(weight) * to_vdb(z_up(around_.frame_.velocities[i]));
        sum.pressure += static_cast<float>(weight) * around_.frame_.pressures[i];
        weights += weight;
      }
      if (weights <= 0.0) return {};
      return {sum.velocity / static_cast<float>(weights), sum.pressure / static_cast<float>(weights)};
    }

   private:
    const Neighbourhood& around_;
    vdb::tools::PointIndexGrid::ConstAccessor access_;
    vdb::tools::PointIndexIterator<> found_;
  };

 private:
  const Cloud& cloud_;
  const ParticleFrame& frame_;
  double reach_;
  vdb::math::Transform::Ptr transform_;
  vdb::tools::PointIndexGrid::Ptr index_;
};

FluidSurface to_surface(const Polygons& mesh, const Neighbourhood& around) {
  FluidSurface out;
  Neighbourhood::Reader reader(around);
  out.positions.reserve(mesh.points.size());
  for (const vdb::Vec3s& point : mesh.points) {
    out.positions.push_back(y_up(from_vdb(point)));
    const Neighbourhood::Sample sample = reader.at(vdb::Vec3d(point));
    out.velocities.push_back(y_up(from_vdb(sample.velocity)));
    out.pressures.push_back(sample.pressure);
  }
  out.normals.assign(mesh.points.size(), glm::vec3(0.0f));
  for (const vdb::Vec3I& t : mesh.triangles) {
    out.triangles.emplace_back(t[0], t[1], t[2]);
    const glm::vec3 twice_area =
        glm::cross(out.positions[t[1]] - out.positions[t[0]], out.positions[t[2]] - out.positions[t[0]]);
    for (int corner = 0; corner < 3; ++corner) out.normals[t[corner]] += twice_area;
  }
  for (glm::vec3& normal : out.normals) {
    const float length = glm::length(normal);
    normal = length > 0.0f ? normal / length : glm::vec3(0.0f, 1.0f, 0.0f);
  }
  out.volume = volume_of(mesh);
  return out;
}

/// The level set at the chosen level, and the motion around it, as grids of a file.
void add_grids(const vdb::FloatGrid& grid, double level, const Neighbourhood& around,
               const std::string& suffix, vdb::GridPtrVec& grids) {
  vdb::FloatGrid::Ptr surface = vdb::tools::levelSetRebuild(grid, static_cast<float>(level), kBand, kBand);
  surface->setName("surface" + suffix);
  surface->setGridClass(vdb::GRID_LEVEL_SET);
  vdb::Vec3SGrid::Ptr velocity = vdb::Vec3SGrid::create();
  velocity->setTree(std::make_shared<vdb::Vec3STree>(surface->tree(), vdb::Vec3s(0.0f), vdb::TopologyCopy()));
  velocity->setTransform(surface->transformPtr()->copy());
  velocity->setVectorType(vdb::VEC_CONTRAVARIANT_RELATIVE);
  velocity->setName("velocity" + suffix);
  vdb::FloatGrid::Ptr pressure = vdb::FloatGrid::create();
  pressure->setTree(std::make_shared<vdb::FloatTree>(surface->tree(), 0.0f, vdb::TopologyCopy()));
  pressure->setTransform(surface->transformPtr()->copy());
  pressure->setName("pressure" + suffix);
  Neighbourhood::Reader reader(around);
  vdb::FloatGrid::Accessor pressures = pressure->getAccessor();
  for (vdb::Vec3SGrid::ValueOnIter voxel = velocity->beginValueOn(); voxel; ++voxel) {
    const Neighbourhood::Sample sample = reader.at(velocity->indexToWorld(voxel.getCoord()));
    voxel.setValue(sample.velocity);
    pressures.setValueOnly(voxel.getCoord(), sample.pressure);
  }
  grids.insert(grids.end(), {surface, velocity, pressure});
}

FluidSurface surface_of(const Cloud& cloud, const ParticleFrame& frame, double spacing,
                        const std::string& suffix, vdb::GridPtrVec* grids) {
  const double voxel = kSurfaceVoxel * spacing;
  vdb::FloatGrid::Ptr balls = vdb::createLevelSet<vdb::FloatGrid>(voxel, kBand);
  vdb::tools::ParticlesToLevelSet<vdb::FloatGrid> raster(*balls);
  raster.rasterizeSpheres(cloud, kSurfaceBall * spacing);
  raster.finalize(true);
  // Distances anew: inside a union of balls they are not those to its surface, and only true ones can be set
  // back without opening what the balls have closed.
  vdb::FloatGrid::Ptr level_set = vdb::tools::levelSetRebuild(*balls, 0.0f, kBand, kInnerBand);
  vdb::tools::Filter<vdb::FloatGrid>(*level_set).mean(1, 1);
  const double level =
      level_of_volume(*level_set, static_cast<double>(cloud.size()) * spacing * spacing * spacing, spacing);
  const Neighbourhood around(cloud, frame, spacing);
  if (grids != nullptr) add_grids(*level_set, level, around, suffix, *grids);
  return to_surface(polygons_at(*level_set, level), around);
}

std::string as_file(const vdb::GridPtrVec& grids, const ParticleFrame& frame, const ExportedFluids& fluids) {
  vdb::MetaMap about;
  about.insertMeta("creator", vdb::StringMetadata("slosh"));
  about.insertMeta("time_s", vdb::DoubleMetadata(frame.time));
  about.insertMeta("spacing_m", vdb::DoubleMetadata(fluids.spacing));
  about.insertMeta("axes", vdb::StringMetadata("z up, as Blender; metres"));
  std::ostringstream bytes;
  vdb::io::Stream(bytes).write(grids, about);
  return std::move(bytes).str();
}

}  // namespace

SurfaceFrame make_surfaces(const ParticleFrame& frame, const ExportedFluids& fluids, bool with_vdb,
                           int threads) {
  static std::once_flag once;
  std::call_once(once, [] { vdb::initialize(); });
  SurfaceFrame out;
  vdb::GridPtrVec grids;
  tbb::task_arena arena(std::max(1, threads));
  arena.execute([&] {
    for (std::size_t fluid = 0; fluid < fluids.names.size(); ++fluid) {
      Cloud cloud;
      for (std::size_t i = 0; i < frame.size(); ++i) {
        if (frame.fluids[i] != fluid) continue;
        cloud.positions.push_back(to_vdb(z_up(frame.positions[i])));
        cloud.of_frame.push_back(i);
      }
      FluidSurface surface;
      const std::string suffix = fluids.names.size() > 1 ? "_" + fluids.names[fluid] : "";
      if (cloud.size() > 0)
        surface = surface_of(cloud, frame, fluids.spacing, suffix, with_vdb ? &grids : nullptr);
      surface.fluid = fluid;
      surface.particle_volume =
          static_cast<double>(cloud.size()) * fluids.spacing * fluids.spacing * fluids.spacing;
      out.fluids.push_back(std::move(surface));
    }
    if (with_vdb) out.vdb = as_file(grids, frame, fluids);
  });
  return out;
}

}  // namespace slosh
