/* A device of no hardware: a handle of 0.2 kg on a weak spring that the force moves. OPTIONS: stiffness of
 * that spring, N/m (default 50). Begin here with yours. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "peer/devices/plugin/slosh_device.h"

static const double kMass = 0.2;    /* kg */
static const double kDamping = 4.0; /* N s/m */

typedef struct handle {
  double stiffness; /* N/m */
  double position[3];
  double velocity[3];
  double force[3];
  double last_s; /* when it was read; < 0: not yet */
} handle;

static double now_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

uint32_t slosh_device_version(void) { return SLOSH_DEVICE_VERSION; }

int slosh_device_open(const char* options, void** device, char* error, size_t size) {
  char* end = NULL;
  const double stiffness = options[0] == '\0' ? 50.0 : strtod(options, &end);
  if ((end != NULL && *end != '\0') || !(stiffness > 0.0 && stiffness <= 1000.0)) {
    snprintf(error, size, "the option '%s' is no stiffness from 0 to 1000 N/m", options);
    return -1;
  }
  handle* made = calloc(1, sizeof *made);
  if (made == NULL) {
    snprintf(error, size, "there is no memory");
    return -1;
  }
  made->stiffness = stiffness;
  made->last_s = -1.0;
  *device = made;
  return 0;
}

int slosh_device_get_capabilities(void* device, slosh_device_capabilities* c) {
  (void)device;
  memset(c, 0, sizeof *c);
  snprintf(c->name, sizeof c->name, "example");
  c->period_s = 0.001;
  c->max_force_n = 10.0;
  c->max_torque_nm = 0.5;
  c->max_force_rate_n_s = 2000.0;
  c->max_torque_rate_nm_s = 100.0;
  c->max_stiffness_n_m = 2000.0;
  c->max_damping_n_s_m = 10.0;
  c->max_rotational_stiffness_nm_rad = 5.0;
  c->max_rotational_damping_nm_s_rad = 0.05;
  c->own_damping_n_s_m = kDamping;
  c->own_rotational_damping_nm_s_rad = 0.01;
  c->workspace_radius_m = 0.1;
  return 0;
}

int slosh_device_read(void* device, slosh_device_reading* reading) {
  handle* h = device;
  const double now = now_s();
  double left = h->last_s < 0.0 ? 0.0 : fmin(now - h->last_s, 0.05);
  h->last_s = now;
  for (; left > 0.0; left -= 0.0005) {
    const double dt = fmin(left, 0.0005);
    for (int i = 0; i < 3; ++i) {
      const double pull = h->force[i] - h->stiffness * h->position[i] - kDamping * h->velocity[i];
      h->velocity[i] += dt * pull / kMass;
      h->position[i] += dt * h->velocity[i];
    }
  }
  memset(reading, 0, sizeof *reading);
  memcpy(reading->position_m, h->position, sizeof h->position);
  memcpy(reading->velocity_m_s, h->velocity, sizeof h->velocity);
  reading->orientation_wxyz[0] = 1.0;
  reading->flags = SLOSH_READING_HAS_TWIST;
  return 0;
}

int slosh_device_write(void* device, const double force_n[3], const double torque_nm[3]) {
  handle* h = device;
  (void)torque_nm; /* it does not turn */
  memcpy(h->force, force_n, sizeof h->force);
  return 0;
}

void slosh_device_close(void* device) { free(device); }
