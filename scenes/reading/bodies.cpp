// Bodies, probes, fluids and pictures.
#include <algorithm>
#include <cmath>

#include "scenes/gltf/meshes.h"
#include "scenes/mesh/united.h"
#include "scenes/reading/reading.h"
#include "sim/math/convex.h"

namespace slosh::reading {
namespace {

using gltf::Extras;
using gltf::Range;

/// A point probe turns with nothing; its inertia only has to be a number that divides.
constexpr double kProbeRadius = 0.005;
constexpr double kProbeMass = 0.05;
constexpr std::size_t kMaxBodies = 10'000;
constexpr std::size_t kMaxPictures = 4096;  // as a network carries

/// Symmetric positive definite, and no moment above the sum of the other two.
bool is_inertia(const glm::dmat3& m) {
  const double minor = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  const double trace = m[0][0] + m[1][1] + m[2][2];
  for (int axis = 0; axis < 3; ++axis) {
    if (m[axis][axis] > 0.5001 * trace) return false;
  }
  return m[0][0] > 0.0 && minor > 0.0 && glm::determinant(m) > 0.0;
}

void read_common(Extras& extras, Body& body) {
  body.particle_density = extras.number("particle_density_kg_m3", 0.0, Range{0.0, 1e6});
  body.friction = extras.number("friction", body.friction, Range{0.0, 10.0});
  body.restitution = extras.number("restitution", body.restitution, Range{0.0, 1.0});
  body.measured = extras.flag("measured", false);
}

/// A wall sticks unless it says that it slips.
void read_wall_viscosity(Extras& extras, Body& body) {
  const bool slips = extras.flag("slip", false);
  body.dynamic_viscosity = extras.number("viscosity_pa_s", kFluidsViscosity, Range{0.0, 1e7});
  if (!slips) return;
  if (body.dynamic_viscosity > 0.0) {
    extras.fail("slip", "is true, and viscosity_pa_s is not 0",
                "Keep slip for a free-slip wall, viscosity_pa_s for a no-slip one");
  }
  body.dynamic_viscosity = kFreeSlip;
}

void read_repeat(Extras& extras, Body& body) {
  body.repeats = extras.flag("repeat", false);
  if (extras.has("repeat") && body.motion != BodyMotion::kDriven)
    extras.fail("repeat", "is a driven body's", "Give motion = \"driven\", or leave it out");
}

void read_mass(Extras& extras, const mesh::VolumeIntegrals& volume, Body& body) {
  const double mass = extras.number("mass_kg", 0.0, gltf::kPositive);
  const double density = extras.number("density_kg_m3", 0.0, Range{0.0, 1e6, true});
  if (extras.has("mass_kg") && extras.has("density_kg_m3")) {
    extras.fail("mass_kg", "is given together with density_kg_m3", "Keep one of the two");
  }
  if (body.motion == BodyMotion::kFree && !extras.has("mass_kg") && !extras.has("density_kg_m3")) {
    extras.fail("mass_kg", "is missing on a free body",
                "Give mass_kg or density_kg_m3, or motion = \"fixed\"");
  }
  body.mass.mass = extras.has("density_kg_m3") ? density * volume.volume : mass;
  body.mass.center_of_mass = extras.vector("center_of_mass_m", volume.centroid, Range{-1e4, 1e4});
  body.mass.inertia = volume.inertia * (body.mass.mass / volume.volume);
  if (extras.has("center_of_mass_m") && !extras.has("inertia_kg_m2")) {
    // The mesh's inertia is about its own centroid: carry it over (parallel axes).
    const glm::dvec3 d = body.mass.center_of_mass - volume.centroid;
    body.mass.inertia += body.mass.mass * (glm::dmat3(glm::dot(d, d)) - glm::outerProduct(d, d));
  }
  const std::vector<double> i = extras.numbers("inertia_kg_m2", 6, Range{-1e9, 1e9});
  if (!i.empty()) {
    body.mass.inertia = glm::dmat3(i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2]);
    if (!is_inertia(body.mass.inertia)) {
      extras.fail("inertia_kg_m2", "is not the inertia of a solid",
                  "Give xx, yy, zz, xy, xz, yz about the centre of mass, or leave it out");
    }
  }
}

void read_cutting(Extras& extras, Body& body) {
  body.pieces = extras.integer("pieces", 0, 2, kMaxPieces);
  body.cut_n_m = extras.number("cut_n_m", 0.0, Range{0.0, 1e6});
  body.blade = extras.flag("blade", false);
  if (body.pieces > 0 && body.motion != BodyMotion::kFree)
    extras.fail("pieces", "is given to a body that is not free", "Give motion = \"free\", or leave it out");
  if (body.pieces == 0 && extras.has("cut_n_m"))
    extras.fail("cut_n_m", "is given to a body that cannot be cut", "Give pieces = 2, or leave it out");
  if (body.blade && (body.motion == BodyMotion::kFixed || body.pieces > 0))
    extras.fail("blade", "is given to a body that is fixed, or cut itself",
                "Give motion = \"free\" or \"driven\", and no pieces");
  for (const char* key : {"center_of_mass_m", "inertia_kg_m2"})
    if (body.pieces > 0 && extras.has(key))
      extras.fail(key, "is given to a body that may be cut",
                  "Leave it out: it is of one density all through");
}

/// What is cut must stay convex in every part.
Problem check_pieces(const Reading& reading, int node, const Body& body) {
  if (body.pieces == 0) return std::nullopt;
  const mesh::WeldedMesh welded = mesh::weld(reading.scene.meshes[body.mesh]);
  if (welded.triangles.size() > kMaxCutTriangles)
    return Error{reading.document.owner(node),
                 "may be cut, and has " + std::to_string(welded.triangles.size()) + " triangles, more than " +
                     std::to_string(kMaxCutTriangles),
                 "In Blender: Decimate, or leave pieces out"};
  if (is_convex<glm::dvec3>(welded.points, welded.triangles)) return std::nullopt;
  return Error{reading.document.owner(node), "may be cut, and its mesh is not convex",
               "In Blender: Mesh > Convex Hull, or leave pieces out"};
}

/// Parts that lie in each other are one solid, also where a hollow was meant.
void note_overlap(Reading& reading, int node, const mesh::United& united) {
  if (united.overlap <= 0.0) return;
  reading.notes.push_back(
      {"parts-overlap",
       {reading.document.owner(node),
        "its parts overlap: " + gltf::short_number(1e3 * united.overlap) +
            " litres lie in several of "
            "them and count once, of " +
            gltf::short_number(1e3 * united.solid.volume) + " together",
        "Where a part was to be a hollow, turn its faces inward: Mesh > Normals > Flip"}});
}

}  // namespace

Problem read_body(Reading& reading, int node) {
  Body body;
  body.name = reading.document.name(node);
  glm::dmat3 rest;
  if (Problem problem = read_pose(reading, node, body.pose, rest)) return problem;
  Extras extras(reading.document.extras[node], reading.document.owner(node));
  extras.text("slosh", "");
  const std::string motion = extras.choice("motion", "fixed", {"fixed", "free", "driven"});
  body.motion = motion == "free"     ? BodyMotion::kFree
                : motion == "driven" ? BodyMotion::kDriven
                                     : BodyMotion::kFixed;
  read_repeat(extras, body);
  body.starts_away = extras.flag("starts_away", false);
  // What comes and goes is carried along like what moves.
  const bool stands = body.motion == BodyMotion::kFixed;
  if (body.starts_away && stands) body.motion = BodyMotion::kDriven;
  const Problem mesh_problem = read_node_mesh(reading, node, rest, true, body.mesh);
  mesh::VolumeIntegrals volume;
  volume.volume = 1.0;  // so that fields are looked at where there is no solid to weigh
  if (!mesh_problem) {
    const mesh::WeldedMesh welded = mesh::weld(reading.scene.meshes[body.mesh]);
    mesh::Components parts;
    mesh::find_defects(welded, &parts);
    const mesh::United united = mesh::integrate_union(welded, parts);
    volume = united.solid;
    note_overlap(reading, node, united);
  }
  read_mass(extras, volume, body);
  read_common(extras, body);
  read_cutting(extras, body);
  read_wall_viscosity(extras, body);
  if (extras.has("temperature_c")) body.temperature = extras.number("temperature_c", 20.0, kTemperatures);
  body.twist.linear = extras.vector("velocity_m_s", glm::dvec3(0.0), Range{-1e3, 1e3});
  body.twist.angular = extras.vector("angular_velocity_rad_s", glm::dvec3(0.0), Range{-1e3, 1e3});
  if (body.motion == BodyMotion::kDriven) {
    for (const char* key : {"velocity_m_s", "angular_velocity_rad_s"})
      if (extras.has(key))
        extras.fail(key, "is given to a driven body", "Leave it out: its keys say how it moves");
  }
  body.material = read_material(reading, reading.document.model.nodes[node].mesh);
  if (Problem problem = all_of(reading, mesh_problem, extras)) return problem;
  if (body.motion == BodyMotion::kDriven && stands) {
    body.keys = {{0.0, body.pose}};
  } else if (body.motion == BodyMotion::kDriven) {
    if (Problem problem = read_keys(reading, node, body)) return problem;
  }
  if (Problem problem = check_pieces(reading, node, body)) return problem;
  if (Problem problem = check_place(reading, node, body.mesh, body.pose)) return problem;
  const int first = static_cast<int>(reading.scene.bodies.size());
  if (reading.scene.bodies.size() + static_cast<std::size_t>(std::max(body.pieces, 1)) > kMaxBodies) {
    return Error{reading.document.owner(node), "more than " + std::to_string(kMaxBodies) + " bodies",
                 "Use fewer"};
  }
  reading.body_of_node[node] = first;
  reading.scene.bodies.push_back(body);
  for (int number = 2; number <= body.pieces; ++number) {
    Body piece = body;
    piece.name += "~" + std::to_string(number);
    piece.pieces = 0;
    piece.piece_of = first;
    piece.measured = false;
    piece.twist = {};
    piece.starts_away = true;
    reading.scene.bodies.push_back(std::move(piece));
  }
  return std::nullopt;
}

Problem read_probe(Reading& reading, int node) {
  Body body;
  body.name = reading.document.name(node);
  body.motion = BodyMotion::kFree;
  body.point_probe = true;
  glm::dmat3 rest;
  if (Problem problem = read_pose(reading, node, body.pose, rest)) return problem;
  Extras extras(reading.document.extras[node], reading.document.owner(node));
  extras.text("slosh", "");
  body.mass.mass = extras.number("mass_kg", kProbeMass, gltf::kPositive);
  body.mass.inertia = glm::dmat3(0.4 * body.mass.mass * kProbeRadius * kProbeRadius);
  read_common(extras, body);
  body.dynamic_viscosity = extras.number("viscosity_pa_s", 0.0, Range{0.0, 1e7});
  if (Problem problem = all_of(reading, std::nullopt, extras)) return problem;
  if (Problem problem = check_place(reading, node, -1, body.pose)) return problem;
  const int look = reading.document.model.nodes[node].mesh;
  if (look >= 0) {
    if (const Problem problem = read_node_mesh(reading, node, rest, false, body.mesh))
      reading.notes.push_back({"picture", *problem});
    else
      body.material = read_material(reading, look);
  }
  reading.body_of_node[node] = static_cast<int>(reading.scene.bodies.size());
  reading.scene.bodies.push_back(std::move(body));
  return std::nullopt;
}

Problem read_fluid_volume(Reading& reading, int node) {
  Scene& scene = reading.scene;
  FluidVolume volume;
  volume.name = reading.document.name(node);
  glm::dmat3 rest;
  if (Problem problem = read_pose(reading, node, volume.pose, rest)) return problem;
  Extras extras(reading.document.extras[node], reading.document.owner(node));
  extras.text("slosh", "");
  const std::string name = extras.text("fluid", volume.name);
  volume.velocity = extras.vector("velocity_m_s", glm::dvec3(0.0), Range{-1e3, 1e3});
  volume.starts_away = extras.flag("starts_away", false);
  volume.fillings = static_cast<int>(extras.number("fillings", 1.0, Range{1.0, double{kMaxFillings}}));
  Fluid fluid;
  fluid.name = name;
  read_fluid_fields(extras, fluid);
  const auto declared = reading.declared_fluids.find(name);
  if (declared != reading.declared_fluids.end()) {
    for (const char* key : kFluidFields) {
      if (extras.has(key)) {
        extras.fail(key, "is given here and, for fluid \"" + name + "\", in the scene's fluids",
                    "Keep one of the two");
      }
    }
    volume.fluid = declared->second;
  } else {
    // Nodes that name one fluid without the scene declaring it share it when they agree.
    volume.fluid = -1;
    for (std::size_t i = 0; i < scene.fluids.size(); ++i) {
      const Fluid& other = scene.fluids[i];
      if (other.name != name) continue;
      volume.fluid = static_cast<int>(i);
      if (other != fluid) {
        extras.fail("fluid", "\"" + name + "\" has other properties on another node",
                    "Give both nodes the same, or declare the fluid once in the scene's fluids");
      }
    }
    if (volume.fluid < 0) {
      volume.fluid = static_cast<int>(scene.fluids.size());
      scene.fluids.push_back(fluid);
    }
  }
  if (scene.fluids.size() > 250) extras.fail("fluid", "is one of more than 250 fluids", "Use fewer");
  const Problem mesh_problem = read_node_mesh(reading, node, rest, true, volume.mesh);
  if (Problem problem = all_of(reading, mesh_problem, extras)) return problem;
  if (Problem problem = check_place(reading, node, volume.mesh, volume.pose)) return problem;
  scene.fluid_volumes.push_back(std::move(volume));
  reading.volume_nodes.push_back(node);
  return std::nullopt;
}

Problem find_carriers(Reading& reading) {
  for (std::size_t v = 0; v < reading.volume_nodes.size(); ++v) {
    const int carrier = body_node_above(reading, reading.volume_nodes[v]);
    if (carrier >= 0) reading.scene.fluid_volumes[v].body = reading.body_of_node.at(carrier);
  }
  return std::nullopt;
}

Problem read_picture(Reading& reading, int node) {
  if (reading.scene.pictures.size() >= kMaxPictures) {
    reading.notes.push_back({"picture",
                             {reading.document.owner(node),
                              "is one of more than " + std::to_string(kMaxPictures) +
                                  " things that are only looked at, and is not shown",
                              "In Blender: join them (Ctrl J)"}});
    return std::nullopt;
  }
  Picture picture;
  picture.name = reading.document.name(node);
  glm::dmat3 rest;
  // A node without the key is only looked at: its properties, if any, are somebody else's.
  Problem problem = read_pose(reading, node, picture.pose, rest);
  if (!problem) problem = read_node_mesh(reading, node, rest, false, picture.mesh);
  if (problem) {
    problem->what += "; it is not shown";
    reading.notes.push_back({"picture", *problem});
    return std::nullopt;
  }
  picture.material = read_material(reading, reading.document.model.nodes[node].mesh);
  reading.scene.pictures.push_back(std::move(picture));
  return std::nullopt;
}

}  // namespace slosh::reading
