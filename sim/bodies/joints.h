// Hinges, sliders and fixed joints between bodies: all that they hold is solved at once, by one factor over
// all joints, so that neither a chain's length nor a ratio of masses matters. Motors and stops are rows of
// the contacts' solve, which act with every joint kept. Between two steps joints let go and close.
#pragma once

#include <set>
#include <span>
#include <utility>
#include <vector>

#include "sim/bodies/contact_rows.h"
#include "sim/bodies/driven_bodies.h"
#include "sim/bodies/joint_frame.h"
#include "sim/bodies/skyline.h"
#include "sim/snapshot.h"

namespace slosh {

/// Whether a joint holds. In the step in which it closes it does not break: that step's reaction is the blow
/// of closing, which is the larger the shorter the step. What let go is not open before its frames were
/// farther apart than it closes from: else it would close again at once.
enum class JointHold : std::uint8_t { kJoined, kJustJoined, kParted, kOpen };
constexpr bool holds(JointHold hold) {
  return hold == JointHold::kJoined || hold == JointHold::kJustJoined;
}

/// What a joint keeps from one sub-step to the next.
struct KeptJoint {
  double position = 0.0;  ///< rad or m when the last sub-step began, whole turns counted
  double motor = 0.0;     ///< N·m·s or N·s on the first body along the axis
  double stop = 0.0;      ///< likewise: above 0 by the lower stop, below by the upper
  Wrench impulse;         ///< N·s and N·m·s of all its rows on the first body, about the joint, world axes
  JointHold hold = JointHold::kJoined;
  Pose rest{};  ///< where a fixed one holds its first frame, in the second's axes
};

/// What an impulse of one row does to the bodies beyond its own two, with all joints kept.
struct JointSpread {
  std::vector<std::pair<int, Vector6>> responses;  ///< a body's twist a unit
  std::vector<std::pair<int, double>> on_rows;     ///< how fast a unit would open the held rows; sparse
};

/// A motor or a stop as a row of the contacts' solve.
struct AxisRow {
  int joint = 0;
  int a = 0, b = -1;  ///< bodies, b may be the world
  bool motor = false;
  double sign = 1.0;  ///< of the row along the axis
  rows::Constraint row;
  JointSpread spread;
  double least = 0.0, most = 0.0;  ///< N·s or N·m·s
  double begin = 0.0;              ///< the last sub-step's
  rows::Targets target;            ///< least speeds along the row; a motor's own
};

class JointSystem {
 public:
  JointSystem(const Scene& scene, const std::vector<RigidBody>& bodies);

  bool empty() const { return joints_.empty(); }
  /// Bodies that joints connect, directly or through free ones, have one number; −1: no joint.
  int group_of(int body) const { return groups_.empty() ? -1 : groups_[static_cast<std::size_t>(body)]; }

  /// Forgets the means over the last step.
  void begin_step();
  /// Damps the turning of a body that the forces in its joints would turn back too stiffly for a sub-step of
  /// `dt` s, a light link that carries much, by what it adds to `drag` (World::drags) and to `external`. True
  /// where it is anything.
  bool add_stiffness(int body, const std::vector<RigidBody>& bodies, double dt, Matrix6& drag,
                     Wrench& external) const;
  /// Changes the solved velocities so that the joints hold at the sub-step's end. `driven` has driven its
  /// bodies.
  void begin(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt,
             std::vector<BodySolve>& solves);
  /// Makes a contact's row between two bodies one that keeps all joints.
  void keep_joints(int a, int b, rows::Constraint& row, JointSpread& spread) const;
  std::vector<AxisRow>& axis_rows() { return axes_; }
  /// After the contacts' solve: an impulse that it gave, for what the held rows gave with it.
  void count(const JointSpread& spread, double impulse);
  /// Puts right what the contacts' solve left of second order, and undoes drift along the way of the poses
  /// alone. `share`: of the step.
  void finish(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt, double share,
              std::vector<BodySolve>& solves);

  /// At a step's end, of `time_step` s: joints whose reaction was above what they bear let go, and open ones
  /// whose frames come near each other close. True where any did. Neither gives an impulse: what a closing
  /// joint takes away is the next sub-step's solve's to find.
  bool change(const std::vector<RigidBody>& bodies, double time_step);
  /// Pairs of bodies that joints hold together, the lower index first; with the world's −1.
  const std::set<std::pair<int, int>>& connected() const { return connected_; }

  /// A body's centre of mass is elsewhere in it: it went back by `off`, m, in its axes.
  void recentre(int body, const glm::dvec3& off);

  /// Adds the last sub-step's impulses to the momenta.
  void predict(const std::vector<RigidBody>& bodies, std::span<ViscousBody> out) const;

  void fill(const std::vector<RigidBody>& bodies, std::vector<JointState>& out) const;
  const std::vector<KeptJoint>& kept() const { return kept_; }
  /// Means over the last step; positions and speeds are not set.
  const std::vector<JointState>& means() const { return means_; }
  void restore(std::vector<KeptJoint> kept, std::vector<JointState> means);

 private:
  struct Linked {
    JointKind kind = JointKind::kHinge;
    JointSide first, second;
    double lower = 0.0, upper = 0.0, damping = 0.0, motor_speed = 0.0, motor_limit = 0.0;
    double breaks_force = 0.0, breaks_torque = 0.0, joins_within = 0.0, joins_turn = 0.0;
    bool first_free = false, second_free = false;
    std::vector<int> neighbours{};  // joints before it, and itself, that share a free body
  };
  // A row of one joint in this sub-step.
  struct Held {
    int joint = 0;
    JointRow row;
    rows::Row on_first, on_second;
    double give = 0.0;     // of a damper: speed a unit of impulse
    double off = 0.0;      // m or rad when the sub-step begins
    double impulse = 0.0;  // N·s or N·m·s
    bool damper = false;
  };

  void regroup();
  bool near(const Linked& joint, const std::vector<RigidBody>& bodies, double ahead) const;
  JointFrames frames(const Linked& joint, const std::vector<RigidBody>& bodies) const;
  double unwrapped(std::size_t joint, const JointFrames& frames) const;
  rows::Row row_on(int body, const std::vector<RigidBody>& bodies, const std::vector<BodySolve>& solves,
                   const JointFrames& frames, JointRow row, double sign) const;
  double speed_of(const Held& held, const std::vector<BodySolve>& solves, Vector6 BodySolve::* speed) const;
  void make_rows(const std::vector<RigidBody>& bodies, double dt, const std::vector<BodySolve>& solves);
  void factor();
  void make_axes(const std::vector<RigidBody>& bodies, const std::vector<BodySolve>& solves, double dt);
  void apply(const std::vector<double>& impulses, Vector6 BodySolve::* speed,
             std::vector<BodySolve>& solves) const;
  void turn_rows(const std::vector<RigidBody>& poses, const std::vector<BodySolve>& solves);
  double find_wrong(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt,
                    Vector6 BodySolve::* way, double left, const std::vector<BodySolve>& solves);
  std::vector<double> kinetic_energies(const std::vector<BodySolve>& solves) const;
  /// Of a row's joint, below the number of bodies.
  std::size_t group(std::size_t row) const;
  void give(const std::vector<double>& impulses, double sign, std::vector<BodySolve>& solves);
  void hold_speeds(std::vector<BodySolve>& solves);
  void bend(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt,
            std::vector<BodySolve>& solves);
  void correct_travel(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt,
                      std::vector<BodySolve>& solves);
  void report(const std::vector<RigidBody>& bodies, double dt, double share);

  std::vector<Linked> joints_;
  std::vector<int> groups_;
  std::set<std::pair<int, int>> connected_;
  std::vector<std::vector<int>> joints_of_body_;  // free ones'
  std::vector<KeptJoint> kept_;
  std::vector<JointState> means_;
  // Of this sub-step:
  std::vector<Held> rows_;
  std::vector<std::size_t> first_row_;  // of each joint, and their number
  std::vector<std::vector<int>> rows_of_body_;
  std::vector<double> opened_;  // by what the contacts' solve gave, a held row each
  std::vector<double> wrong_;   // m/s or rad/s, likewise
  std::vector<double> bent_;    // impulses of bend(), likewise
  std::vector<double> lost_;    // J that hold_speeds() took, a group each
  std::vector<double> worst_;   // m or rad, likewise
  bool holds_ = true;           // the joints hold at the sub-step's end
  std::vector<AxisRow> axes_;
  std::vector<RigidBody> ends_;  // at the sub-step's end
  Skyline matrix_;
};

}  // namespace slosh
