#include "peer/output/export/particle_files.h"

#include <array>
#include <bit>
#include <cstdio>

#include "sim/math/format.h"

namespace slosh {
namespace {

static_assert(std::endian::native == std::endian::little, "files are written in the machine's byte order");
static_assert(sizeof(glm::vec3) == 12);

std::string base64(const std::string& bytes) {
  static constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < have ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= have ? kLetters[group >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

/// The appended part of a VTU file: each array after its length in bytes, both in base64.
class Appended {
 public:
  /// Returns the array's offset in the part.
  std::size_t add(const void* data, std::size_t bytes) {
    const std::size_t at = text_.size();
    std::string block;
    block.reserve(bytes + 8);
    append_number(block, static_cast<std::uint64_t>(bytes));
    block.append(static_cast<const char*>(data), bytes);
    text_ += base64(block);
    return at;
  }
  template <class T>
  std::size_t add(const std::vector<T>& values) {
    return add(values.data(), values.size() * sizeof(T));
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string data_array(const char* type, const char* name, int components, std::size_t offset) {
  return format(
      "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%zu\"/>\n",
      type, name, components, offset);
}

}  // namespace

std::string ply_beginning(double time, const ExportedFluids& fluids) {
  std::string head = "ply\nformat binary_little_endian 1.0\ncomment slosh\n";
  head += format("comment time_s %.9g\ncomment spacing_m %.9g\n", time, fluids.spacing);
  head += "comment axes z up, as Blender: metres, seconds, pascals\n";
  for (std::size_t i = 0; i < fluids.names.size(); ++i)
    head += format("comment fluid %zu is %s\n", i, fluids.names[i].c_str());
  return head;
}

std::string particles_as_ply(const ParticleFrame& frame, const ExportedFluids& fluids) {
  std::string out = ply_beginning(frame.time, fluids);
  out += format("element vertex %zu\n", frame.size());
  for (const char* name : {"x", "y", "z", "vx", "vy", "vz", "pressure"})
    out += format("property float %s\n", name);
  out += "property uchar fluid\nproperty uint id\nend_header\n";
  out.reserve(out.size() + frame.size() * 33);
  for (std::size_t i = 0; i < frame.size(); ++i) {
    append_vector(out, z_up(frame.positions[i]));
    append_vector(out, z_up(frame.velocities[i]));
    append_number(out, frame.pressures[i]);
    append_number(out, frame.fluids[i]);
    append_number(out, frame.ids[i]);
  }
  return out;
}

std::string particles_as_vtu(const ParticleFrame& frame, const ExportedFluids& fluids) {
  const std::size_t count = frame.size();
  std::vector<std::int64_t> connectivity(count);
  std::vector<std::int64_t> offsets(count);
  for (std::size_t i = 0; i < count; ++i) {
    connectivity[i] = static_cast<std::int64_t>(i);
    offsets[i] = static_cast<std::int64_t>(i) + 1;
  }
  const std::vector<std::uint8_t> types(count, 1);  // VTK_VERTEX
  Appended data;
  std::string out = "<?xml version=\"1.0\"?>\n<!-- slosh: metres, seconds, pascals; y up. ";
  out += format("Spacing %.9g m.", fluids.spacing);
  for (std::size_t i = 0; i < fluids.names.size(); ++i) {
    // A comment may not hold "--", and a name may.
    std::string name = fluids.names[i];
    for (std::size_t at = name.find('-'); at != std::string::npos; at = name.find('-', at)) name[at] = '_';
    out += format(" Fluid %zu is %s.", i, name.c_str());
  }
  out +=
      " -->\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n";
  out +=
      "<UnstructuredGrid>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" ";
  out += format("format=\"ascii\">%.12g</DataArray>\n</FieldData>\n", frame.time);
  out += format("<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n<Points>\n", count, count);
  out += data_array("Float32", "Points", 3, data.add(frame.positions));
  out += "</Points>\n<Cells>\n";
  out += data_array("Int64", "connectivity", 1, data.add(connectivity));
  out += data_array("Int64", "offsets", 1, data.add(offsets));
  out += data_array("UInt8", "types", 1, data.add(types));
  out += "</Cells>\n<PointData Vectors=\"velocity\" Scalars=\"pressure\">\n";
  out += data_array("Float32", "velocity", 3, data.add(frame.velocities));
  out += data_array("Float32", "pressure", 1, data.add(frame.pressures));
  out += data_array("UInt8", "fluid", 1, data.add(frame.fluids));
  out += data_array("UInt32", "id", 1, data.add(frame.ids));
  out += "</PointData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"base64\">\n_";
  out += data.text();
  out += "\n</AppendedData>\n</VTKFile>\n";
  return out;
}

std::string vtu_collection(const std::vector<std::string>& files, const std::vector<double>& times) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t i = 0; i < files.size(); ++i)
    out += format("<DataSet timestep=\"%.12g\" part=\"0\" file=\"%s\"/>\n", times[i], files[i].c_str());
  return out + "</Collection>\n</VTKFile>\n";
}

}  // namespace slosh
