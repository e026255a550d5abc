// Bodies that have left the world for good (sim/bodies/body_room.h), each told once.
#pragma once

#include <string>
#include <vector>

#include "sim/math/format.h"
#include "sim/snapshot.h"

namespace slosh {

struct GoneBody {
  int body = 0;           ///< of the scene
  double time = 0.0;      ///< s, simulated, when it was seen to be gone
  glm::dvec3 where{0.0};  ///< m, world, of its centre of mass
};

/// For people, who, when and where: "'ball' left the world at 1.20 s, at (0.10 -2.35 0.00) m".
inline std::string gone_text(const std::string& name, const GoneBody& gone) {
  return (name.empty() ? "body " + std::to_string(gone.body) : "'" + name + "'") +
         format(" left the world at %.2f s, at (%.2f %.2f %.2f) m", gone.time, gone.where.x, gone.where.y,
                gone.where.z);
}

/// What follows from it, for who can do something about it.
constexpr const char* kGoneAdvice = ": it moves no more and cannot be held until the world is set back";

/// One thread's.
class GoneBodies {
 public:
  /// Those that are gone now and were not when it was last asked; one that was set back may go again.
  const std::vector<GoneBody>& update(const BodySnapshot& now) {
    known_.resize(now.bodies.size(), 0);
    found_.clear();
    for (std::size_t b = 0; b < now.bodies.size(); ++b) {
      const BodyState& body = now.bodies[b];
      if (body.gone && !body.away() && !known_[b])
        found_.push_back({static_cast<int>(b), now.time, body.center_of_mass});
      known_[b] = body.gone;
    }
    return found_;
  }

 private:
  std::vector<char> known_;
  std::vector<GoneBody> found_;
};

}  // namespace slosh
