// Scenes made in Python: closed meshes with the custom properties that a scene file has, written and read
// back by the same code as any file.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "net/text/nearest.h"
#include "peer/python/bindings.h"
#include "peer/python/hand.h"
#include "peer/python/words.h"
#include "scenes/load.h"
#include "scenes/make/writer.h"

namespace slosh::python {
namespace {

using make::Solid;
using nlohmann::json;
using Indices = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;

json to_json(const std::string& name, const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<py::dict>(value)) {
    json object = json::object();
    for (const auto& [key, each] : value.cast<py::dict>())
      object[key.cast<std::string>()] = to_json(name, each);
    return object;
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    const auto is_object = [](const py::handle& each) { return py::isinstance<py::dict>(each); };
    if (const py::sequence list = value.cast<py::sequence>();
        std::any_of(list.begin(), list.end(), is_object)) {
      json array = json::array();
      for (const py::handle& each : list) array.push_back(to_json(name, each));
      return array;
    }
  }
  const std::optional<Numbers> numbers = numbers_of(value);
  if (!numbers) throw py::type_error(name + ": wants a number, a text, True or False, or a list of numbers");
  if (numbers->ndim() == 0) return *numbers->data();
  return std::vector<double>(numbers->data(), numbers->data() + numbers->size());
}

json to_fields(const py::kwargs& fields) {
  json out = json::object();
  for (const auto& [key, value] : fields) {
    const std::string name = key.cast<std::string>();
    out[name] = to_json(name, value);
  }
  return out;
}

make::Paint to_paint(const py::object& color, double metallic, double roughness) {
  make::Paint paint;
  paint.metallic = metallic;
  paint.roughness = roughness;
  if (color.is_none()) return paint;
  const std::vector<double> c = color.cast<std::vector<double>>();
  if (c.size() != 3 && c.size() != 4)
    throw py::value_error("color: red, green, blue and perhaps alpha, 0 to 1, linear");
  paint.color = {c[0], c[1], c[2], c.size() == 4 ? c[3] : 1.0};
  return paint;
}

Solid to_solid(const Numbers& points, const Indices& triangles) {
  if (points.ndim() != 2 || points.shape(1) != 3) throw py::value_error("points: (n, 3) metres");
  if (triangles.ndim() != 2 || triangles.shape(1) != 3)
    throw py::value_error("triangles: (m, 3) indices into points");
  Solid solid;
  for (py::ssize_t i = 0; i < points.shape(0); ++i)
    solid.points.emplace_back(points.at(i, 0), points.at(i, 1), points.at(i, 2));
  for (py::ssize_t i = 0; i < triangles.shape(0); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (triangles.at(i, c) >= solid.points.size())
        throw py::value_error("triangles: row " + std::to_string(i) + " names a point that is not there");
    }
    solid.triangles.emplace_back(triangles.at(i, 0), triangles.at(i, 1), triangles.at(i, 2));
  }
  return solid;
}

/// By the divergence theorem; right for a closed mesh that faces outward.
double volume(const Solid& solid) {
  double six = 0.0;
  for (const glm::uvec3& t : solid.triangles)
    six += glm::dot(solid.points[t.x], glm::cross(solid.points[t.y], solid.points[t.z]));
  return six / 6.0;
}

constexpr const char* kBuilt = "the built scene";  // in place of a file's name

class SceneBuilder {
 public:
  explicit SceneBuilder(const py::kwargs& fields) : writer_(to_fields(fields)) {}

  void add(const std::string& kind, const std::string& name, const Solid* solid, const py::object& pose,
           const py::object& color, const std::string& parent, json fields) {
    if (nodes_.contains(name))
      throw py::value_error("'" + name + "' is there already: every part has a name of its own");
    if (!kind.empty()) fields["slosh"] = kind;
    int on = -1;
    if (!parent.empty()) {
      const auto found = nodes_.find(parent);
      if (found == nodes_.end()) {
        std::vector<std::string> parts;
        for (const auto& [part, node] : nodes_) parts.push_back(part);
        throw py::key_error("there is no part '" + parent + "' yet. " + did_you_mean(parent, parts) +
                            "Add it first");
      }
      on = found->second;
    }
    int mesh = -1;
    if (solid) mesh = writer_.add_mesh(name, *solid, writer_.add_material(name, to_paint(color, 0.0, 0.5)));
    nodes_[name] = writer_.add_node(name, mesh, to_hand_pose(pose, Pose{}).pose, fields, on);
  }

  void add_hand(const std::string& name, const std::string& grip, const py::object& motion,
                std::optional<double> duration, double rate) {
    if (!(rate >= 1.0 && rate <= 1000.0)) throw py::value_error("rate: 1 to 1000 keys a second");
    std::function<Pose(double)> at;
    double length = duration.value_or(0.0);
    if (py::isinstance<Keys>(motion)) {
      const Keys& keys = motion.cast<const Keys&>();
      if (!duration) length = keys.keys.back().time;
      at = [track = PoseTrack(keys.keys, Pose{})](double time) mutable { return track.at(time).pose; };
    } else {
      if (!duration) throw py::value_error("duration: a motion by a function needs it, s");
      at = [motion](double time) { return to_hand_pose(motion(time), Pose{}).pose; };
    }
    if (!(length > 0.0 && length <= 86400.0)) throw py::value_error("duration: above 0 s, a day at most");
    writer_.add_hand(name, grip, at, length, rate);
  }

  void camera(const py::object& eye, const py::object& target, double fov) {
    writer_.add_camera(to_vector(eye, "eye"), to_vector(target, "target"), fov);
  }

  void write(const std::filesystem::path& file) {
    const std::string extension = file.extension().string();
    if (extension != ".glb" && extension != ".gltf")
      throw py::value_error("file: a name that ends in .glb or .gltf");
    if (nodes_.empty())
      throw Raised({"slosh.SceneBuilder", "nothing is in it", "Add a body, a fluid, a grip first"});
    // The writer does not look whether its file takes what it writes.
    const bool opened = static_cast<bool>(std::ofstream(file, std::ios::binary));
    std::error_code code;
    if (!opened || !writer_.write(file) || std::filesystem::file_size(file, code) == 0 || code)
      throw Raised({file.string(), "cannot be written", "Is there such a folder, and may you write there?"});
  }

  std::shared_ptr<Scene> scene() {
    const std::filesystem::path pattern = std::filesystem::temp_directory_path() / "slosh-XXXXXX";
    std::string folder = pattern.string();
    if (!mkdtemp(folder.data()))
      throw Raised({folder, "cannot be made", "Is the disk full? TMPDIR names another place"});
    struct Gone {
      std::string folder;
      ~Gone() {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
      }
    } const gone{folder};
    const std::filesystem::path file = std::filesystem::path(folder) / "scene.glb";
    write(file);
    Result<Scene> read = load_scene(file);
    if (!read) {  // a file of ours that is gone by then tells nobody anything
      Error error = read.error();
      const std::size_t at = error.where.find(file.string());
      if (at != std::string::npos) error.where.replace(at, file.string().size(), kBuilt);
      throw Raised(std::move(error));
    }
    read.value().source_file = kBuilt;
    return std::make_shared<Scene>(std::move(read.value()));
  }

 private:
  make::SceneWriter writer_;
  std::map<std::string, int> nodes_;
};

constexpr const char* kPlace =
    "pose: a Pose, 3 numbers (m), (position, quaternion) or 7 numbers; of the world, or of `on` where that "
    "is given.\n";

std::vector<glm::dvec2> to_profile(const Numbers& profile) {
  if (profile.ndim() != 2 || profile.shape(1) != 2 || profile.shape(0) < 3)
    throw py::value_error("profile: (n, 2) of radius and height, m, n at least 3");
  std::vector<glm::dvec2> line;
  for (py::ssize_t i = 0; i < profile.shape(0); ++i) line.emplace_back(profile.at(i, 0), profile.at(i, 1));
  return line;
}

double positive(double value, const char* what) {
  if (!(value > 0.0 && std::isfinite(value))) throw py::value_error(std::string(what) + ": above 0");
  return value;
}

void bind_shapes(py::module_& m) {
  py::class_<Solid>(
      m, "Mesh",
      "A closed surface: points (n, 3) m, triangles (m, 3) indices, counter-clockwise seen from outside.")
      .def(py::init(&to_solid), py::arg("points"), py::arg("triangles"))
      .def_property_readonly(
          "points",
          [](const Solid& s) {
            std::vector<double> out;
            for (const glm::dvec3& p : s.points) append(out, p);
            return as_array(std::move(out), {static_cast<py::ssize_t>(s.points.size()), 3});
          },
          "(n, 3) m, a copy")
      .def_property_readonly(
          "triangles",
          [](const Solid& s) {
            py::array_t<std::uint32_t> out({static_cast<py::ssize_t>(s.triangles.size()), py::ssize_t{3}});
            for (std::size_t i = 0; i < s.triangles.size(); ++i)
              for (int c = 0; c < 3; ++c) out.mutable_at(static_cast<py::ssize_t>(i), c) = s.triangles[i][c];
            return out;
          },
          "(m, 3) uint32, a copy")
      .def_property_readonly("volume", &volume, "m³, of a closed mesh that faces outward")
      .def(
          "moved",
          [](const Solid& s, const py::object& pose) {
            const Pose p = to_hand_pose(pose, Pose{}).pose;
            Solid out = s;
            for (glm::dvec3& point : out.points) point = transform_point(p, point);
            return out;
          },
          py::arg("pose"), "The same mesh elsewhere.")
      .def(
          "__add__", [](const Solid& a, const Solid& b) { return make::merged(a, b); }, py::arg("other"),
          "Both side by side: closed parts of one body.");
  m.def(
      "box",
      [](const py::object& low, const py::object& high) {
        const glm::dvec3 a = to_vector(low, "low");
        const glm::dvec3 b = to_vector(high, "high");
        if (!(a.x < b.x && a.y < b.y && a.z < b.z))
          throw py::value_error("low, high: low is below high in each direction");
        return make::box(a, b);
      },
      py::arg("low"), py::arg("high"), "A box between two corners, (3,) m each.");
  m.def(
      "tank",
      [](const py::object& inner, double wall) {
        const glm::dvec3 size = to_vector(inner, "inner");
        for (int i = 0; i < 3; ++i) positive(size[i], "inner");
        return make::tank(size, positive(wall, "wall"));
      },
      py::arg("inner"), py::arg("wall"),
      "A box open at the top: the hollow is inner (3,) m in size, stands on y = wall, centred on x = z = 0.");
  m.def(
      "sphere",
      [](double radius, int rings, int segments) {
        if (rings < 3 || rings > 1000 || segments < 3 || segments > 1000)
          throw py::value_error("rings, segments: 3 to 1000");
        return make::sphere(positive(radius, "radius"), rings, segments);
      },
      py::arg("radius"), py::arg("rings") = 24, py::arg("segments") = 48,
      "A ball about the origin; radius in m.");
  m.def(
      "capsule",
      [](double radius, double low, double high, int rings, int segments) {
        if (!(low < high)) throw py::value_error("low, high: low is below high");
        if (rings < 3 || rings > 1000 || segments < 3 || segments > 1000)
          throw py::value_error("rings, segments: 3 to 1000");
        return make::capsule(positive(radius, "radius"), low, high, rings, segments);
      },
      py::arg("radius"), py::arg("low"), py::arg("high"), py::arg("rings") = 8, py::arg("segments") = 24,
      "A rod along y with round ends; low and high are the ends of its straight part, m.");
  m.def(
      "lathe",
      [](const Numbers& profile, int segments) {
        if (segments < 3 || segments > 1000) throw py::value_error("segments: 3 to 1000");
        return make::lathe(to_profile(profile), segments);
      },
      py::arg("profile"), py::arg("segments") = 48,
      "profile (n, 2) of radius and height, m, turned about the y axis; the solid lies to the left of the "
      "way. It begins\n"
      "and ends on the axis (radius 0), or is a closed ring off the axis.");
}

}  // namespace

void bind_builder(py::module_& m) {
  bind_shapes(m);
  py::class_<SceneBuilder>(m, "SceneBuilder",
                           "A scene from nothing. Keywords are the scene's own custom properties "
                           "(scenes/FIELDS.md): title, spacing_m,\n"
                           "duration_s, settle_s, domain_min_m, ... Those of the parts likewise. What they "
                           "may be is checked by scene(), with\n"
                           "the same words as for a file.")
      .def(py::init<const py::kwargs&>())
      .def(
          "body",
          [](SceneBuilder& b, const std::string& name, const Solid& mesh, const py::object& pose,
             const py::object& color,
             const py::kwargs& fields) { b.add("body", name, &mesh, pose, color, "", to_fields(fields)); },
          py::arg("name"), py::arg("mesh"), py::arg("pose") = py::make_tuple(0.0, 0.0, 0.0),
          py::arg("color") = py::none(),
          (std::string("A rigid body. ") + kPlace +
           "Fields: motion='fixed' or 'free', mass_kg or density_kg_m3, friction, restitution, slip, "
           "measured, ...")
              .c_str())
      .def(
          "fluid",
          [](SceneBuilder& b, const std::string& name, const Solid& mesh, const py::object& pose,
             const py::object& color,
             const py::kwargs& fields) { b.add("fluid", name, &mesh, pose, color, "", to_fields(fields)); },
          py::arg("name"), py::arg("mesh"), py::arg("pose") = py::make_tuple(0.0, 0.0, 0.0),
          py::arg("color") = py::none(),
          (std::string("A volume that starts full of fluid. ") + kPlace +
           "Fields: density_kg_m3, viscosity_pa_s, fluid (a name that volumes share), velocity_m_s, ...")
              .c_str())
      .def(
          "picture",
          [](SceneBuilder& b, const std::string& name, const Solid& mesh, const py::object& pose,
             const py::object& color) { b.add("picture", name, &mesh, pose, color, "", json::object()); },
          py::arg("name"), py::arg("mesh"), py::arg("pose") = py::make_tuple(0.0, 0.0, 0.0),
          py::arg("color") = py::none(), "A mesh that is only looked at.")
      .def(
          "grip",
          [](SceneBuilder& b, const std::string& name, const std::string& on, const py::object& pose,
             const py::kwargs& fields) {
            b.add("grip", name, nullptr, pose, py::none(), on, to_fields(fields));
          },
          py::arg("name"), py::arg("on"), py::arg("pose") = py::make_tuple(0.0, 0.0, 0.0),
          (std::string("Where a hand takes hold of the body or probe `on`. ") + kPlace +
           "Fields: stiffness_n_m, damping_n_s_m, rotational_stiffness_nm_rad, rotational_damping_nm_s_rad, "
           "device.")
              .c_str())
      .def(
          "probe",
          [](SceneBuilder& b, const std::string& name, const py::object& pose, const py::kwargs& fields) {
            b.add("probe", name, nullptr, pose, py::none(), "", to_fields(fields));
          },
          py::arg("name"), py::arg("pose"), "A point that feels fluid. Fields: mass_kg, viscosity_pa_s, ...")
      .def(
          "gauge",
          [](SceneBuilder& b, const std::string& name, const py::object& pose, const std::string& on) {
            b.add("gauge", name, nullptr, pose, py::none(), on, json::object());
          },
          py::arg("name"), py::arg("pose"), py::arg("on") = "",
          "A point at which level and pressure are read.")
      .def(
          "region",
          [](SceneBuilder& b, const std::string& name, const Solid& mesh, const py::object& pose,
             const std::string& on) { b.add("region", name, &mesh, pose, py::none(), on, json::object()); },
          py::arg("name"), py::arg("mesh"), py::arg("pose") = py::make_tuple(0.0, 0.0, 0.0),
          py::arg("on") = "", "A closed mesh in which the fluid is weighed.")
      .def("hand", &SceneBuilder::add_hand, py::arg("name"), py::arg("grip"), py::arg("motion"),
           py::arg("duration") = py::none(), py::arg("rate") = 60.0,
           "The scripted hand of a grip. motion: Keys, or a function time (s) -> pose (world) with "
           "`duration` s, keyed `rate`\n"
           "times a second. At time 0 it is within 50 mm of its grip.")
      .def("camera", &SceneBuilder::camera, py::arg("eye"), py::arg("target"),
           py::arg("vertical_fov_deg") = 40.0, "Where the view starts, (3,) m each.")
      .def("write", &SceneBuilder::write, py::arg("file"),
           "Writes a .glb, or a .gltf with everything inside. Raises slosh.Error.")
      .def("scene", &SceneBuilder::scene,
           "The Scene, checked as a file is. Raises slosh.Error that names node and field.");
}

}  // namespace slosh::python
