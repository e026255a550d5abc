#include "peer/devices/shared_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "peer/devices/device_file.h"
#include "peer/output/whole_file.h"

namespace slosh {
namespace {

constexpr double kStill = 0.15;         // s for which both have been where they are
constexpr double kStillWithin = 0.004;  // m
constexpr double kGraspCloses = 0.6;    // of the button's way; opens below kGraspOpens
constexpr double kGraspOpens = 0.4;

using Matrix4 = std::array<std::array<double, 4>, 4>;

/// The eigenvector of the largest eigenvalue of a symmetric matrix, by Jacobi's rotations.
std::array<double, 4> largest_eigenvector(Matrix4 a) {
  Matrix4 v{};
  for (std::size_t i = 0; i < 4; ++i) v[i][i] = 1.0;
  for (int sweep = 0; sweep < 50; ++sweep) {
    for (std::size_t p = 0; p < 4; ++p) {
      for (std::size_t q = p + 1; q < 4; ++q) {
        if (a[p][q] == 0.0) continue;
        const double angle = 0.5 * std::atan2(2.0 * a[p][q], a[q][q] - a[p][p]);
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        for (std::size_t k = 0; k < 4; ++k) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y;
          a[k][q] = s * x + c * y;
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y;
          a[q][k] = s * x + c * y;
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const double x = v[k][p], y = v[k][q];
          v[k][p] = c * x - s * y;
          v[k][q] = s * x + c * y;
        }
      }
    }
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (a[i][i] > a[best][best]) best = i;
  return {v[0][best], v[1][best], v[2][best], v[3][best]};
}

/// Horn's quaternion of the rotation that turns `from` (about its mean) nearest to `to` (about its mean).
glm::dquat nearest_rotation(std::span<const TouchedPlace> places, const glm::dvec3& from,
                            const glm::dvec3& to) {
  glm::dmat3 s(0.0);  // s[j][i]: sum of device's i times room's j
  for (const TouchedPlace& place : places) s += glm::outerProduct(place.at_device - from, place.in_room - to);
  const auto m = [&](int i, int j) { return s[j][i]; };
  const Matrix4 n = {
      {{m(0, 0) + m(1, 1) + m(2, 2), m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0)},
       {m(1, 2) - m(2, 1), m(0, 0) - m(1, 1) - m(2, 2), m(0, 1) + m(1, 0), m(2, 0) + m(0, 2)},
       {m(2, 0) - m(0, 2), m(0, 1) + m(1, 0), -m(0, 0) + m(1, 1) - m(2, 2), m(1, 2) + m(2, 1)},
       {m(0, 1) - m(1, 0), m(2, 0) + m(0, 2), m(1, 2) + m(2, 1), -m(0, 0) - m(1, 1) + m(2, 2)}}};
  const auto [w, x, y, z] = largest_eigenvector(n);
  return glm::normalize(glm::dquat(w, x, y, z));
}

/// How far apart the farthest two are, and how far the others reach off the line through those.
std::array<double, 2> spread(std::span<const TouchedPlace> places, glm::dvec3 TouchedPlace::* which) {
  double length = 0.0;
  glm::dvec3 end(0.0), way(1.0, 0.0, 0.0);
  for (const TouchedPlace& a : places) {
    for (const TouchedPlace& b : places) {
      const double apart = glm::distance(a.*which, b.*which);
      if (apart <= length) continue;
      length = apart;
      end = a.*which;
      way = (b.*which - a.*which) / apart;
    }
  }
  double off = 0.0;
  for (const TouchedPlace& place : places)
    off = std::max(off, glm::length(glm::cross(place.*which - end, way)));
  return {length, off};
}

std::string millimetres(double m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f mm", 1e3 * m);
  return text;
}

}  // namespace

Result<SharedSpace> fit_shared_space(std::span<const TouchedPlace> places) {
  const char* const where = "device and headset";
  const std::string wide = "Touch three corners of a triangle, each side at least 10 cm";
  if (places.size() < kPlacesToTouch)
    return Error{where, std::to_string(places.size()) + " places were touched, three are needed", wide};
  for (const auto which : {&TouchedPlace::at_device, &TouchedPlace::in_room}) {
    const auto [length, off] = spread(places, which);
    if (!(length >= kMinReach))
      return Error{where, "the touched places are within " + millimetres(length) + " of each other", wide};
    if (!(off >= kMinReach))
      return Error{where, "the touched places lie on one line, but for " + millimetres(off), wide};
  }
  glm::dvec3 from(0.0), to(0.0);
  for (const TouchedPlace& place : places) {
    from += place.at_device / static_cast<double>(places.size());
    to += place.in_room / static_cast<double>(places.size());
  }
  SharedSpace space;
  space.device_in_room.orientation = nearest_rotation(places, from, to);
  space.device_in_room.position = to - space.device_in_room.orientation * from;
  double sum = 0.0;
  for (const TouchedPlace& place : places) {
    const glm::dvec3 off =
        space.device_in_room.position + space.device_in_room.orientation * place.at_device - place.in_room;
    sum += glm::dot(off, off);
  }
  space.residual = std::sqrt(sum / static_cast<double>(places.size()));
  if (!(space.residual <= kMaxResidual)) {
    return Error{where,
                 "the places that the device touched and those of the controller do not fit: " +
                     millimetres(space.residual) + " off in the mean, the limit is " +
                     millimetres(kMaxResidual),
                 "Hold the controller's grip to the tip the same way each time, both still"};
  }
  return space;
}

std::filesystem::path shared_space_file(const std::string& device) {
  const std::filesystem::path folder = device_settings_folder();
  return folder.empty() ? folder : folder / (device + ".room");
}

Result<bool> keep_shared_space(const std::filesystem::path& file, const SharedSpace& space) {
  const char* const mend = "Check that the folder is writable and has room";
  if (file.empty())
    return Error{"device and headset", "cannot be kept: there is no folder of the user's",
                 "Set HOME or XDG_CONFIG_HOME"};
  std::error_code code;
  std::filesystem::create_directories(file.parent_path(), code);
  if (code) return Error{file.string(), "cannot be written: " + code.message(), mend};
  const glm::dvec3& p = space.device_in_room.position;
  const glm::dquat& q = space.device_in_room.orientation;
  char text[400];
  std::snprintf(
      text, sizeof text,
      "# Where this device stands in the headset's room, by ./slosh devices calibrate.\n"
      "x_m = %.6f\ny_m = %.6f\nz_m = %.6f\nqw = %.9f\nqx = %.9f\nqy = %.9f\nqz = %.9f\nresidual_m = %.6f\n",
      p.x, p.y, p.z, q.w, q.x, q.y, q.z, space.residual);
  if (const Result<bool> written = write_whole(file, text); !written)
    return Error{written.error().where, written.error().what, mend};
  return true;
}

Result<std::optional<SharedSpace>> kept_shared_space(const std::filesystem::path& file) {
  std::error_code code;
  if (file.empty() || !std::filesystem::exists(file, code)) return std::optional<SharedSpace>();
  Result<DeviceFile> read = DeviceFile::read(file);
  if (!read) return read.error();
  DeviceFile& lines = read.value();
  SharedSpace space;
  glm::dvec3& p = space.device_in_room.position;
  p.x = lines.number("x_m", 0.0, -100.0, 100.0);
  p.y = lines.number("y_m", 0.0, -100.0, 100.0);
  p.z = lines.number("z_m", 0.0, -100.0, 100.0);
  glm::dquat q(lines.number("qw", 0.0, -1.0, 1.0), lines.number("qx", 0.0, -1.0, 1.0),
               lines.number("qy", 0.0, -1.0, 1.0), lines.number("qz", 0.0, -1.0, 1.0));
  space.residual = lines.number("residual_m", 0.0, 0.0, kMaxResidual);
  if (std::abs(glm::length(q) - 1.0) > 0.01)
    lines.refuse("qw", "qw, qx, qy, qz are no rotation", "Calibrate again: ./slosh devices calibrate");
  if (const Result<bool> fine = lines.check(); !fine) return fine.error();
  space.device_in_room.orientation = glm::normalize(q);
  return std::optional(space);
}

TouchPlaces::Heard TouchPlaces::follow(double time, const std::optional<glm::dvec3>& tip,
                                       const HandReading& left, const HandReading& right) {
  Seen now{time, tip, {}};
  const HandReading* hands[2] = {&left, &right};
  for (std::size_t side = 0; side < 2; ++side)
    if (hands[side]->tracked) now.hands[side] = hands[side]->pose.position;
  seen_.push_back(now);
  // One older than kStill is kept, so that the time is spanned.
  while (seen_.size() > 2 && time - seen_[1].time >= kStill) seen_.erase(seen_.begin());

  Heard heard = Heard::kNothing;
  for (std::size_t side = 0; side < 2; ++side) {
    const HandReading& hand = *hands[side];
    const bool was = closed_[side];
    const double pulled = static_cast<double>(std::max(hand.squeeze, hand.trigger));
    closed_[side] = hand.tracked ? pulled > (was ? kGraspOpens : kGraspCloses) : was;
    if (was || !closed_[side] || complete() || heard != Heard::kNothing) continue;
    const bool still =
        tip && time - seen_.front().time >= kStill && std::ranges::all_of(seen_, [&](const Seen& before) {
          return before.tip && before.hands[side] && glm::distance(*before.tip, *tip) <= kStillWithin &&
                 glm::distance(*before.hands[side], hand.pose.position) <= kStillWithin;
        });
    if (!still) {
      heard = Heard::kMoved;
      continue;
    }
    const bool near = std::ranges::any_of(
        places_, [&](const TouchedPlace& place) { return glm::distance(place.at_device, *tip) < kMinReach; });
    heard = near ? Heard::kTooNear : Heard::kTaken;
    if (!near) places_.push_back({*tip, hand.pose.position});
  }
  return heard;
}

}  // namespace slosh
