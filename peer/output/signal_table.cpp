#include "peer/output/signal_table.h"

#include <limits>

#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string fields_of(const Pose& pose) {
  const glm::dvec3& p = pose.position;
  const glm::dquat& q = pose.orientation;
  return format(",%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", p.x, p.y, p.z, q.w, q.x, q.y, q.z);
}

std::string fields_of(const Wrench& w) {
  return format(",%.6g,%.6g,%.6g,%.6g,%.6g,%.6g", w.force.x, w.force.y, w.force.z, w.torque.x, w.torque.y,
                w.torque.z);
}

}  // namespace

std::string signals_header() {
  std::string names = "time_s,tick,device,wall_s,period_ms,reading,age_ms,engaged";
  for (const char* pose : {"device_", "hand_"})
    for (const char* field : {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"})
      names += std::string(",") + pose + field;
  names += ",hand_vx_m_s,hand_vy_m_s,hand_vz_m_s,hand_wx_rad_s,hand_wy_rad_s,hand_wz_rad_s";
  for (const char* stage : {"coupled_", "guarded_", "wanted_", "sent_", "rendered_"})
    for (const char* field : {"fx_n", "fy_n", "fz_n", "tx_nm", "ty_nm", "tz_nm"})
      names += std::string(",") + stage + field;
  return names;
}

std::string signals_row(const SignalSample& s) {
  const Pose no_pose{glm::dvec3(kNan), glm::dquat(kNan, kNan, kNan, kNan)};
  const Wrench no_wrench{glm::dvec3(kNan), glm::dvec3(kNan)};
  std::string row = format("%.6f,%llu,%u,%.6f,%.4f,%llu,%.4f,%d", s.time,
                           static_cast<unsigned long long>(s.tick), s.device, s.wall, 1e3 * s.period,
                           static_cast<unsigned long long>(s.reading), 1e3 * s.age, s.engaged ? 1 : 0);
  row += fields_of(s.at_device.value_or(no_pose)) + fields_of(s.hand);
  row += fields_of(Wrench{s.hand_twist.linear, s.hand_twist.angular});
  for (const Wrench& w : {s.coupled, s.guarded, s.wanted, s.sent, s.rendered.value_or(no_wrench)})
    row += fields_of(w);
  return row + "\n";
}

}  // namespace slosh
