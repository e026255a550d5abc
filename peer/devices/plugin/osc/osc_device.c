/* A tracker that is told of over Open Sound Control (UDP): a position device of no force. OPTIONS are in
 * peer/devices/PROTOCOLS.md. Trackers of one port share it: one sender tells of both hands. */
#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "peer/devices/plugin/osc/osc_form.h"
#include "peer/devices/plugin/slosh_device.h"

static const double kSilent = 0.25;  /* s without a word after which nothing is said of the tracker */
static const double kLeap = 10.0;    /* m/s: faster is no hand, and gone at once */
static const double kLongest = 0.25; /* s over which it goes to what it was told */
static const double kLately = 1.0;   /* s that a message which could not be used is spoken of */

typedef struct tracker {
  osc_form form;
  struct port* port;
  struct tracker* next;
  /* What came, changed by whoever empties the port. */
  osc_pose received;
  int fresh; /* since its last reading */
  double received_s;
  unsigned long used, wrong;
  double wrong_s;
  char why[240];
  /* Its way to there: trackers speak 30 to 120 times a second, and a hand that stood between would shake
   * what it holds. */
  osc_pose from, to;
  double begin_s, interval_s;
  int begun;
} tracker;

typedef struct port {
  char host[64];
  int number;
  int socket;
  pthread_mutex_t mutex;
  tracker* trackers;
  struct port* next;
  unsigned long messages, others, broken; /* others: of no tracker */
  char other[96];                         /* the last of them */
  const char* why;                        /* what the last broken packet was */
  unsigned char packet[65536];
} port;

static pthread_mutex_t ports_mutex = PTHREAD_MUTEX_INITIALIZER;
static port* ports = NULL;

static double now_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static port* listen_at(const osc_form* form, char* error, size_t size) {
  struct sockaddr_in at;
  memset(&at, 0, sizeof at);
  at.sin_family = AF_INET;
  at.sin_port = htons((uint16_t)form->port);
  inet_pton(AF_INET, form->host, &at.sin_addr);
  port* made = calloc(1, sizeof *made);
  if (made == NULL) {
    snprintf(error, size, "there is no memory");
    return NULL;
  }
  made->socket = socket(AF_INET, SOCK_DGRAM, 0);
  if (made->socket < 0 || bind(made->socket, (const struct sockaddr*)&at, sizeof at) != 0) {
    const int why = errno;
    snprintf(error, size, "UDP port %d of %s cannot be listened at (%s)%s", form->port, form->host,
             strerror(why),
             why == EADDRINUSE      ? ": end the program that has it, or let the tracker send to another"
             : why == EADDRNOTAVAIL ? ": give an address of this machine, or 0.0.0.0 for all of them"
                                    : "");
    if (made->socket >= 0) close(made->socket);
    free(made);
    return NULL;
  }
  fcntl(made->socket, F_SETFL, O_NONBLOCK);
  fcntl(made->socket, F_SETFD, FD_CLOEXEC);
  snprintf(made->host, sizeof made->host, "%s", form->host);
  made->number = form->port;
  pthread_mutex_init(&made->mutex, NULL);
  return made;
}

static void take(void* whom, const osc_message* message) {
  port* const p = whom;
  int mine = 0;
  p->messages += 1;
  for (tracker* t = p->trackers; t != NULL; t = t->next) {
    osc_pose pose = t->received;
    const int said = osc_form_read(&t->form, message, &pose, t->why, sizeof t->why);
    mine |= said != 0;
    if (said < 0) {
      t->wrong += 1;
      t->wrong_s = now_s();
    } else if (said > 0) {
      t->received = pose;
      t->used += 1;
      /* A rotation that comes first waits for its place. */
      if (said == 2) {
        t->fresh = 1;
        t->received_s = now_s();
      }
    }
  }
  if (!mine) {
    p->others += 1;
    snprintf(p->other, sizeof p->other, "%.80s", message->address);
  }
}

/* Under the port's mutex. */
static void empty(port* p) {
  for (int i = 0; i < 256; ++i) {
    const ssize_t got = recv(p->socket, p->packet, sizeof p->packet, 0);
    if (got < 0) return;
    const char* const wrong = osc_walk(p->packet, (size_t)got, take, p);
    if (wrong == NULL) continue;
    p->broken += 1;
    p->why = wrong;
  }
}

/* Along the way from `from` to `to`. */
static void place_at(const tracker* t, double now, osc_pose* pose) {
  const double u = fmin(1.0, fmax(0.0, (now - t->begin_s) / t->interval_s));
  double length = 0.0, dot = 0.0;
  for (int i = 0; i < 4; ++i) dot += t->from.orientation[i] * t->to.orientation[i];
  for (int i = 0; i < 3; ++i)
    pose->position[i] = t->from.position[i] + u * (t->to.position[i] - t->from.position[i]);
  for (int i = 0; i < 4; ++i) {
    pose->orientation[i] =
        (1.0 - u) * t->from.orientation[i] + u * (dot < 0.0 ? -1.0 : 1.0) * t->to.orientation[i];
    length += pose->orientation[i] * pose->orientation[i];
  }
  for (int i = 0; i < 4; ++i) pose->orientation[i] /= sqrt(length); /* at least half: they lie on one side */
}

static void set_out(tracker* t, double gap, double now) {
  osc_pose here = t->received;
  int leaps = !t->begun || gap > kSilent;
  if (!leaps) {
    place_at(t, now, &here);
    t->interval_s =
        fmin(kLongest, fmax(0.001, t->begun == 1 ? gap : t->interval_s + 0.2 * (gap - t->interval_s)));
    double far = 0.0;
    for (int i = 0; i < 3; ++i) far += pow(t->received.position[i] - here.position[i], 2.0);
    leaps = sqrt(far) > kLeap * t->interval_s;
    t->begun = 2;
  } else {
    t->interval_s = 0.02;
    t->begun = 1;
  }
  t->from = leaps ? t->received : here;
  t->to = t->received;
  t->begin_s = now;
}

uint32_t slosh_device_version(void) {
  return SLOSH_DEVICE_VERSION;
}

int slosh_device_open(const char* options, void** device, char* error, size_t size) {
  tracker* made = calloc(1, sizeof *made);
  if (made == NULL) {
    snprintf(error, size, "there is no memory");
    return -1;
  }
  if (osc_form_parse(options, &made->form, error, size) != 0) {
    free(made);
    return -1;
  }
  made->received.orientation[0] = 1.0;
  pthread_mutex_lock(&ports_mutex);
  port* p = ports;
  while (p != NULL && (p->number != made->form.port || strcmp(p->host, made->form.host) != 0)) p = p->next;
  if (p == NULL) {
    p = listen_at(&made->form, error, size);
    if (p != NULL) {
      p->next = ports;
      ports = p;
    }
  }
  if (p != NULL) {
    pthread_mutex_lock(&p->mutex);
    made->port = p;
    made->next = p->trackers;
    p->trackers = made;
    pthread_mutex_unlock(&p->mutex);
  }
  pthread_mutex_unlock(&ports_mutex);
  if (p == NULL) {
    free(made);
    return -1;
  }
  *device = made;
  return 0;
}

int slosh_device_get_capabilities(void* device, slosh_device_capabilities* c) {
  (void)device;
  memset(c, 0, sizeof *c);
  snprintf(c->name, sizeof c->name, "osc");
  c->period_s = 0.001;
  c->kind = SLOSH_DEVICE_POSITION;
  return 0;
}

int slosh_device_read(void* device, slosh_device_reading* reading) {
  tracker* const t = device;
  const double now = now_s();
  pthread_mutex_lock(&t->port->mutex);
  const double last = t->received_s;
  empty(t->port);
  const int fresh = t->fresh;
  if (fresh) set_out(t, t->begun ? t->received_s - last : 0.0, now);
  t->fresh = 0;
  const int silent = !t->begun || now - t->received_s > kSilent;
  pthread_mutex_unlock(&t->port->mutex);
  if (silent) return 1;
  osc_pose pose;
  place_at(t, now, &pose);
  memset(reading, 0, sizeof *reading);
  memcpy(reading->position_m, pose.position, sizeof pose.position);
  memcpy(reading->orientation_wxyz, pose.orientation, sizeof pose.orientation);
  reading->flags = SLOSH_READING_HAS_TWIST;
  if (now - t->begin_s >= t->interval_s) return 0; /* it is there */
  for (int i = 0; i < 3; ++i)
    reading->velocity_m_s[i] = (t->to.position[i] - t->from.position[i]) / t->interval_s;
  /* The rotation vector of to * conj(from), on the shorter side. */
  const double* const a = t->to.orientation;
  const double* const b = t->from.orientation;
  const double w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const double v[3] = {a[1] * b[0] - a[0] * b[1] - a[2] * b[3] + a[3] * b[2],
                       a[2] * b[0] - a[0] * b[2] - a[3] * b[1] + a[1] * b[3],
                       a[3] * b[0] - a[0] * b[3] - a[1] * b[2] + a[2] * b[1]};
  const double sine = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const double turned = 2.0 * atan2(sine, fabs(w)) * (w < 0.0 ? -1.0 : 1.0);
  for (int i = 0; i < 3 && sine > 1e-12; ++i)
    reading->angular_velocity_rad_s[i] = turned * v[i] / sine / t->interval_s;
  return 0;
}

int slosh_device_write(void* device, const double force_n[3], const double torque_nm[3]) {
  (void)device;
  (void)force_n;
  (void)torque_nm;
  return 0;
}

int slosh_device_say(void* device, char* words, size_t size) {
  tracker* const t = device;
  port* const p = t->port;
  const double now = now_s();
  pthread_mutex_lock(&p->mutex);
  const int received = t->begun || t->fresh, silent = received && now - t->received_s > kSilent;
  const int wrong = t->wrong > 0 && now - t->wrong_s < kLately;
  if (received && !silent) {
    if (wrong)
      snprintf(words, size, "%lu of %lu messages could not be used: %s", t->wrong, t->wrong + t->used,
               t->why);
    else
      snprintf(words, size, "%lu messages, a place each %.0f ms", t->used, 1e3 * t->interval_s);
  } else {
    int at = silent ? snprintf(words, size, "the tracker is silent for %.1f s", now - t->received_s)
                    : snprintf(words, size, "listening at %s:%d for %s", p->host, p->number,
                               t->form.entries[0].address);
    for (int i = 1; !silent && i < t->form.count && at > 0 && (size_t)at < size; ++i)
      at += snprintf(words + at, size - (size_t)at, " and %s", t->form.entries[i].address);
    if (!silent && t->form.serial[0] != '\0' && at > 0 && (size_t)at < size)
      at += snprintf(words + at, size - (size_t)at, " of '%s'", t->form.serial);
    if (at > 0 && (size_t)at < size) {
      char* const rest = words + at;
      const size_t room = size - (size_t)at;
      if (t->wrong > 0)
        snprintf(rest, room, "; %s", t->why);
      else if (!silent && p->others > 0)
        snprintf(rest, room, "; %lu messages came that are none of it, the last %s", p->others, p->other);
      else if (!silent && p->broken > 0)
        snprintf(rest, room, "; what came %s", p->why);
      else if (!silent)
        snprintf(rest, room, "; nothing has come%s", p->messages > 0 ? " that tells its place" : "");
    }
  }
  pthread_mutex_unlock(&p->mutex);
  return received && !silent ? 0 : 1;
}

void slosh_device_close(void* device) {
  tracker* const t = device;
  pthread_mutex_lock(&ports_mutex);
  port* const p = t->port;
  pthread_mutex_lock(&p->mutex);
  tracker** at = &p->trackers;
  while (*at != t) at = &(*at)->next;
  *at = t->next;
  const int last = p->trackers == NULL;
  pthread_mutex_unlock(&p->mutex);
  if (last) {
    port** from = &ports;
    while (*from != p) from = &(*from)->next;
    *from = p->next;
    close(p->socket);
    pthread_mutex_destroy(&p->mutex);
    free(p);
  }
  pthread_mutex_unlock(&ports_mutex);
  free(t);
}
