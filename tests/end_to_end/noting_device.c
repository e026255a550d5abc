/* A plug-in of no hardware: a handle that nothing moves, and a file of all that it is sent, a line a write with the
 * moment by the steady clock. OPTIONS: that file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "peer/devices/plugin/slosh_device.h"

#define FLUSHED_EACH 50 /* writes: a process that is killed loses no more */

typedef struct handle {
  FILE* file;
  int unflushed;
} handle;

uint32_t slosh_device_version(void) { return SLOSH_DEVICE_VERSION; }

int slosh_device_open(const char* options, void** device, char* error, size_t size) {
  handle* made = calloc(1, sizeof *made);
  if (made != NULL) made->file = fopen(options, "w");
  if (made == NULL || made->file == NULL) {
    free(made);
    snprintf(error, size, "cannot write %s", options);
    return -1;
  }
  *device = made;
  return 0;
}

int slosh_device_get_capabilities(void* device, slosh_device_capabilities* c) {
  (void)device;
  memset(c, 0, sizeof *c);
  snprintf(c->name, sizeof c->name, "noting");
  c->period_s = 0.001;
  c->max_force_n = 40.0;
  c->max_torque_nm = 2.0;
  c->max_force_rate_n_s = 2000.0;
  c->max_torque_rate_nm_s = 100.0;
  c->max_stiffness_n_m = 2000.0;
  c->max_damping_n_s_m = 20.0;
  c->max_rotational_stiffness_nm_rad = 5.0;
  c->max_rotational_damping_nm_s_rad = 0.05;
  c->own_damping_n_s_m = 20.0;
  c->own_rotational_damping_nm_s_rad = 0.1;
  c->workspace_radius_m = 0.2;
  return 0;
}

int slosh_device_read(void* device, slosh_device_reading* reading) {
  (void)device;
  memset(reading, 0, sizeof *reading);
  reading->orientation_wxyz[0] = 1.0;
  reading->flags = SLOSH_READING_HAS_TWIST;
  return 0;
}

int slosh_device_write(void* device, const double force_n[3], const double torque_nm[3]) {
  handle* h = device;
  struct timespec now;
  (void)torque_nm;
  clock_gettime(CLOCK_MONOTONIC, &now);
  fprintf(h->file, "%lld,%.9g,%.9g,%.9g\n", 1000000000LL * now.tv_sec + now.tv_nsec, force_n[0], force_n[1], force_n[2]);
  if (++h->unflushed >= FLUSHED_EACH) {
    h->unflushed = 0;
    fflush(h->file);
  }
  return 0;
}

void slosh_device_close(void* device) {
  handle* h = device;
  fclose(h->file);
  free(h);
}
