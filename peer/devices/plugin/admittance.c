/* A device of no hardware that measures force and is told where to go (admittance): a stage that follows what
 * it is told 5 ms later, and a hand on it that pulls it to a place by a spring. OPTIONS: "STIFFNESS,PLACE" of
 * the hand in N/m and m along x (default 50,0). Begin here with yours where it measures force. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "peer/devices/plugin/slosh_device.h"

static const double kMass = 1.0;        /* kg that slosh gives the stage */
static const double kDamping = 6.0;     /* N s/m, the same */
static const double kFollowing = 0.005; /* s */
static const double kHandDamping = 4.0; /* N s/m */
static const double kMoveLasts = 0.1;   /* s */

typedef struct stage {
  double stiffness; /* N/m of the hand */
  double place;     /* m where it wants the stage */
  double position[3];
  double velocity[3]; /* in the mean since it was read before */
  slosh_device_motion told;
  double last_s; /* when it was read; < 0: not yet */
  double told_s;
} stage;

static double now_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

uint32_t slosh_device_version(void) {
  return SLOSH_DEVICE_VERSION;
}

int slosh_device_open(const char* options, void** device, char* error, size_t size) {
  double stiffness = 50.0, place = 0.0;
  char rest = 0;
  const int words = sscanf(options, "%lf,%lf%c", &stiffness, &place, &rest);
  if ((options[0] != '\0' && words != 1 && words != 2) || !(stiffness >= 0.0 && stiffness <= 2000.0) ||
      !(fabs(place) <= 0.1)) {
    snprintf(error, size, "the option '%s' is no hand: STIFFNESS,PLACE with 0 to 2000 N/m and -0.1 to 0.1 m",
             options);
    return -1;
  }
  stage* made = calloc(1, sizeof *made);
  if (made == NULL) {
    snprintf(error, size, "there is no memory");
    return -1;
  }
  made->stiffness = stiffness;
  made->place = place;
  made->told.orientation_wxyz[0] = 1.0;
  made->last_s = -1.0;
  *device = made;
  return 0;
}

int slosh_device_get_capabilities(void* device, slosh_device_capabilities* c) {
  (void)device;
  memset(c, 0, sizeof *c);
  snprintf(c->name, sizeof c->name, "admittance");
  c->period_s = 0.001;
  c->max_force_n = 20.0;
  c->max_torque_nm = 1.0;
  c->max_force_rate_n_s = 2000.0;
  c->max_torque_rate_nm_s = 100.0;
  c->max_stiffness_n_m = 10000.0;
  c->max_damping_n_s_m = 50.0;
  c->max_rotational_stiffness_nm_rad = 5.0;
  c->max_rotational_damping_nm_s_rad = 0.05;
  c->own_damping_n_s_m = kDamping;
  c->own_rotational_damping_nm_s_rad = 0.02;
  c->workspace_radius_m = 0.1;
  c->kind = SLOSH_DEVICE_ADMITTANCE;
  c->virtual_mass_kg = kMass;
  c->virtual_inertia_kg_m2 = 1e6; /* it does not turn */
  c->max_speed_m_s = 0.5;
  c->max_turning_rad_s = 3.0;
  c->following_s = kFollowing;
  return 0;
}

int slosh_device_read(void* device, slosh_device_reading* reading) {
  stage* s = device;
  const double now = now_s();
  const double passed = s->last_s < 0.0 ? 0.0 : now - s->last_s;
  const int still = now - s->told_s > kMoveLasts;
  s->last_s = now;
  for (int i = 0; i < 3 && passed > 0.0; ++i) {
    const double way =
        still ? 0.0 : (s->told.position_m[i] - s->position[i]) * (1.0 - exp(-passed / kFollowing));
    s->position[i] += way;
    s->velocity[i] = way / passed;
  }
  memset(reading, 0, sizeof *reading);
  memcpy(reading->position_m, s->position, sizeof s->position);
  reading->orientation_wxyz[0] = 1.0; /* it does not turn */
  for (int i = 0; i < 3; ++i) {
    const double wanted = i == 0 ? s->place : 0.0;
    reading->force_n[i] = s->stiffness * (wanted - s->position[i]) - kHandDamping * s->velocity[i];
  }
  reading->flags = SLOSH_READING_HAS_WRENCH;
  return 0;
}

int slosh_device_write(void* device, const double force_n[3], const double torque_nm[3]) {
  (void)device; /* a device that is moved is sent no force */
  (void)force_n;
  (void)torque_nm;
  return 0;
}

int slosh_device_move(void* device, const slosh_device_motion* motion) {
  stage* s = device;
  s->told = *motion;
  s->told_s = now_s();
  return 0;
}

void slosh_device_close(void* device) {
  free(device);
}
