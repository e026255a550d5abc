// All contacts together, by projected Gauss–Seidel.
#include <algorithm>

#include "sim/bodies/contacts.h"

namespace slosh {

namespace {
constexpr int kIterations = 30;
}

void solve_contacts(const std::vector<Contact>& contacts, const std::vector<ContactMaterial>& materials,
                    const std::vector<RigidBody>& bodies, double dt, std::vector<BodySolve>& solves) {
  std::vector<rows::ContactRows> all;
  all.reserve(contacts.size());
  for (const Contact& c : contacts) {
    const ContactMaterial& a = materials[c.a];
    const ContactMaterial& b = materials[c.b];
    const ContactMaterial material{std::min(a.friction, b.friction), std::max(a.restitution, b.restitution)};
    all.push_back(rows::make_rows(c, material, bodies.data(), dt, solves.data()));
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      rows::solve_once(all[i], solves[contacts[i].a].velocity, solves[contacts[i].b].velocity);
    }
  }
}

}  // namespace slosh
