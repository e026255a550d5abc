// Scenes made in code: what a case of a report, or an experiment of the tests, is built from.
#pragma once

#include <initializer_list>
#include <string>

#include "scenes/make/solid.h"
#include "scenes/scene.h"

namespace slosh::report {

/// A scene under construction. Each add returns the index of what was added.
struct SceneBuilder {
  Scene scene;

  int add_fluid(double rest_density, double viscosity);  ///< kg/m³, Pa·s
  int add_volume(const make::Solid& solid, int fluid = 0, const Pose& pose = {});
  /// A fixed body; its wrench is measured.
  int add_fixed(const std::string& name, const make::Solid& solid, const Pose& pose = {});
  /// A free body of uniform density: centre and inertia from the mesh.
  int add_free(const std::string& name, const make::Solid& solid, double mass, const Pose& pose = {});
  /// A grip at the origin of the body's mesh frame unless a pose is given.
  int add_grip(int body, double stiffness, double damping, double rotational_stiffness = 0.0,
               double rotational_damping = 0.0, const Pose& pose = {});
  /// One so stiff, about its axes as well, that the body is where the hand is: its own inertia does not
  /// count.
  int add_stiff_grip(int body);
  /// Pa·s of these bodies' walls: the fluid's own, where Eq 9's mean is to be the fluid's and they stick.
  void set_viscosity(std::initializer_list<int> bodies, double viscosity);
  void set_domain(const glm::dvec3& lower, const glm::dvec3& upper);

 private:
  int add_mesh(const make::Solid& solid);
};

/// m³, of a closed solid.
double volume_of(const make::Solid& solid);

/// An open box tank whose inner floor lies at y = 0, walls `wall` m thick.
make::Solid tank_at_floor(const glm::dvec3& inner, double wall);

/// A round vessel, open at its top, its inner floor at y = 0: inner `radius` and `height`, walls and floor
/// `wall` thick, in the floor's middle a hole of radius `hole`. m.
make::Solid glass_of(double radius, double height, double wall, double hole = 0.0);

/// What fills it to `height`.
make::Solid filling_of(double radius, double height);

}  // namespace slosh::report
