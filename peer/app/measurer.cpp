#include "peer/app/measurer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace slosh {
namespace {

constexpr double kRounding = 1e-9;  // s

/// Numbers of a row, each after a comma.
class MeasuredRow {
 public:
  explicit MeasuredRow(double time) { add("%.6f", time); }
  template <class Value>
  void add(const char* pattern, Value value) {
    char cell[64];
    std::snprintf(cell, sizeof cell, pattern, value);
    text_ += cell;
  }
  void number(double value) { add(",%.9g", value); }
  void count(std::uint64_t value) { add(",%llu", static_cast<unsigned long long>(value)); }
  void vector(const glm::dvec3& v) {
    for (int axis = 0; axis < 3; ++axis) number(v[axis]);
  }
  void cell(const std::string& text) { text_.append(",").append(csv_cell(text)); }
  std::string line() const { return text_ + "\n"; }

 private:
  std::string text_;
};

// What a joint is measured by: where it is free to move, and where it may let go or holds rigidly.
constexpr char kJointMoves = 1, kJointPulls = 2;
char joint_columns(const Joint& joint) {
  const bool fixed = joint.kind == JointKind::kFixed;
  return static_cast<char>((fixed ? 0 : kJointMoves) | (fixed || joint.changes() ? kJointPulls : 0));
}

void note(MeasuredPlace& place, double value, bool first) {
  if (first) place.start = place.least = place.most = value;
  place.end = value;
  place.least = std::fmin(place.least, value);  // NaN only while there was nothing else
  place.most = std::fmax(place.most, value);
}

}  // namespace

bool asks_to_be_measured(const Scene& scene) {
  return !scene.gauges.empty() || !scene.regions.empty() || !scene.joints.empty() ||
         std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const Body& body) { return body.measured; });
}

Measurer::Measurer(const Scene& scene, const SampledScene& sampled, double interval)
    : instruments_(scene, sampled), interval_(interval) {
  const bool asked = asks_to_be_measured(scene);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (!body.measured && (asked || body.motion != BodyMotion::kFree)) continue;
    Followed followed;
    followed.index = static_cast<int>(b);
    followed.so_far.name = body.name;
    bodies_.push_back(followed);
  }
  for (const Gauge& gauge : scene.gauges) levels_.push_back({gauge.name, 0.0, 0.0, 0.0, 0.0});
  for (const Region& region : scene.regions) masses_.push_back({region.name, 0.0, 0.0, 0.0, 0.0});
  for (std::vector<double>* values : {&motors_, &pulls_, &twists_}) values->resize(scene.joints.size());
  for (const Joint& joint : scene.joints) joint_follows_.push_back(joint_columns(joint));
}

Result<std::unique_ptr<Measurer>> Measurer::create(const Scene& scene, const SampledScene& sampled,
                                                   const std::filesystem::path& folder, double interval) {
  std::unique_ptr<Measurer> measurer(new Measurer(scene, sampled, interval));
  std::string header = kProbesHeader;
  const auto add_column = [&header](const std::string& name) {
    header += ',';
    header += csv_cell(name);
  };
  for (const Gauge& gauge : scene.gauges) {
    add_column(gauge.name + "_level_m");
    add_column(gauge.name + "_pressure_pa");
  }
  for (const Region& region : scene.regions) add_column(region.name + "_mass_kg");
  for (const Joint& joint : scene.joints) {
    const bool hinge = joint.kind == JointKind::kHinge;
    if (joint_columns(joint) & kJointMoves) {
      add_column(joint.name + (hinge ? "_angle_rad" : "_way_m"));
      add_column(joint.name + (hinge ? "_speed_rad_s" : "_speed_m_s"));
      add_column(joint.name + (hinge ? "_motor_nm" : "_motor_n"));
    }
    if (joint_columns(joint) & kJointPulls)
      for (const char* what : {"_joined", "_force_n", "_torque_nm"}) add_column(joint.name + what);
  }
  Result<std::unique_ptr<LaterTable>> probes = LaterTable::create(folder / "probes.csv", header);
  if (!probes) return probes.error();
  measurer->probe_table_ = std::move(probes.value());
  if (measurer->bodies_.empty()) return measurer;
  Result<std::unique_ptr<LaterTable>> bodies = LaterTable::create(folder / "bodies.csv", kBodiesHeader);
  if (!bodies) return bodies.error();
  measurer->body_table_ = std::move(bodies.value());
  return measurer;
}

void Measurer::begin(const World& world, double elapsed) {
  next_ = elapsed;
  world.fill(now_);
  write_rows(world, elapsed);
}

void Measurer::step(const World& world, double elapsed) {
  steps_ += 1;
  all_steps_ += 1;
  if (!bodies_.empty() || !motors_.empty()) {
    world.fill(now_);
    for (std::size_t j = 0; j < motors_.size(); ++j) {
      const JointState& joint = now_.joints[j];
      motors_[j] += joint.motor;
      pulls_[j] = std::max(pulls_[j], glm::length(joint.reaction.force));
      twists_[j] = std::max(twists_[j], glm::length(joint.reaction.torque));
    }
    for (Followed& body : bodies_) {
      const Wrench& fluid = now_.bodies[static_cast<std::size_t>(body.index)].fluid;
      body.since_row.force += fluid.force;
      body.since_row.torque += fluid.torque;
      body.since_start.force += fluid.force;
      body.since_start.torque += fluid.torque;
    }
  }
  if (elapsed + kRounding >= next_) write_rows(world, elapsed);
}

void Measurer::write_rows(const World& world, double elapsed) {
  const Measurement& m = instruments_.measure(world);
  const double share = steps_ > 0 ? 1.0 / static_cast<double>(steps_) : 0.0;
  for (Followed& body : bodies_) {
    const BodyState& state = now_.bodies[static_cast<std::size_t>(body.index)];
    const Wrench mean =
        steps_ > 0 ? Wrench{share * body.since_row.force, share * body.since_row.torque} : state.fluid;
    body.since_row = Wrench{};
    body.so_far.position = state.pose.position;
    body.so_far.peak_force = std::max(body.so_far.peak_force, glm::length(mean.force));
    body.so_far.fluid_inside = m.in_body[static_cast<std::size_t>(body.index)];
    MeasuredRow row(elapsed);
    row.cell(body.so_far.name);
    row.vector(state.pose.position);
    const glm::dquat& q = state.pose.orientation;
    for (const double part : {q.w, q.x, q.y, q.z}) row.number(part);
    row.vector(state.center_of_mass);
    row.vector(state.twist.linear);
    row.vector(state.twist.angular);
    row.vector(mean.force);
    row.vector(mean.torque);
    row.count(body.so_far.fluid_inside);
    body_table_->add(row.line());
  }
  MeasuredRow row(elapsed);
  row.count(m.fluid.particles);
  row.count(m.fluid.spilled);
  row.count(m.fluid.lost);
  row.count(m.in_solids);
  row.number(m.fluid.mass);
  row.vector(m.fluid.center);
  row.vector(m.fluid.momentum);
  row.number(m.fluid.kinetic_energy);
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    row.number(m.levels[i]);
    row.number(m.pressures[i]);
    note(levels_[i], m.levels[i], rows_ == 0);
  }
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    row.number(m.masses[i]);
    note(masses_[i], m.masses[i], rows_ == 0);
  }
  for (std::size_t j = 0; j < motors_.size(); ++j) {
    if (joint_follows_[j] & kJointMoves) {
      row.number(now_.joints[j].position);
      row.number(now_.joints[j].speed);
      row.number(share * motors_[j]);
    }
    if (joint_follows_[j] & kJointPulls) {
      row.count(now_.joints[j].joined);
      row.number(pulls_[j]);
      row.number(twists_[j]);
    }
    motors_[j] = pulls_[j] = twists_[j] = 0.0;
  }
  probe_table_->add(row.line());
  last_ = m.fluid;
  in_solids_ = m.in_solids;
  rows_ += 1;
  steps_ = 0;
  next_ = interval_ * (std::floor((elapsed + kRounding) / interval_) + 1.0);
}

void Measurer::stop() {
  if (body_table_) body_table_->stop();
  probe_table_->stop();
}

MeasuredRun Measurer::report() const {
  MeasuredRun run;
  run.interval = interval_;
  for (const Followed& body : bodies_) {
    run.bodies.push_back(body.so_far);
    const double share = all_steps_ > 0 ? 1.0 / static_cast<double>(all_steps_) : 0.0;
    run.bodies.back().mean_force = share * body.since_start.force;
    run.bodies.back().mean_torque = share * body.since_start.torque;
  }
  run.levels = levels_;
  run.masses = masses_;
  run.center = last_.center;
  run.momentum = last_.momentum;
  run.kinetic_energy = last_.kinetic_energy;
  return run;
}

std::string Measurer::problem() const {
  if (body_table_) {
    if (std::string problem = body_table_->problem(); !problem.empty()) return problem;
  }
  return probe_table_->problem();
}

}  // namespace slosh
