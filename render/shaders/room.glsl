// A room seen out of focus: pale walls, a darker floor, a tall window behind, one large light above. GLSL and C++; pure functions.

// Radiances; to_light: unit, world.
struct Room {
  vec3 sky;      // the ceiling's
  vec3 horizon;  // the walls'
  vec3 ground;   // the floor's
  vec3 softbox;
  vec3 to_light;
};

const float kRoomHalf = 2.6f;     // m from the middle to a wall
const float kRoomFloor = 0.9f;    // m below the eye
const float kRoomCeiling = 1.7f;  // m above it
const float kRoomBlur = 0.09f;    // of a border, as a share of the distance

const vec3 kDaylight = vec3(0.20f, 0.225f, 0.26f);  // through the window, as a share of the large light

SHARED float room_strip(float at, float low, float high) {
  return smoothstep(low - kRoomBlur, low + kRoomBlur, at) * (1.0f - smoothstep(high - kRoomBlur, high + kRoomBlur, at));
}

// Daylight through the window of the wall at −z, 0–1.
SHARED float room_window(vec3 d) {
  if (d.z > -0.05f) return 0.0f;
  float across = d.x / -d.z;
  float up = d.y / -d.z;
  float bar = room_strip(across, -0.52f, -0.50f);
  return room_strip(across, -0.86f, -0.16f) * room_strip(up, -0.22f, 0.62f) * (1.0f - 1.5f * bar);
}

// Radiance from a world direction (unit), without the light.
SHARED vec3 room_radiance(Room room, vec3 direction) {
  vec3 d = direction;
  float side = max(abs(d.x), abs(d.z));
  float wall = side / kRoomHalf;
  float floor_near = -d.y / kRoomFloor;
  // m above the eye where the wall is met; on the floor, the share of the way to the wall.
  float height = clamp(d.y / max(wall, 0.01f), -kRoomFloor, kRoomCeiling);
  float out_there = clamp(wall / max(floor_near, 0.01f), 0.0f, 1.0f);
  float corner = smoothstep(0.0f, 0.5f, abs(abs(d.x) - abs(d.z)) / side);
  vec3 walls = room.horizon * (0.42f + 0.14f * height) * (0.85f + 0.15f * corner);
  vec3 carpet = room.ground * mix(0.55f, 1.25f, out_there * out_there);
  vec3 seen = mix(walls, room.sky, smoothstep(-kRoomBlur, kRoomBlur, d.y / kRoomCeiling - wall));
  seen = mix(seen, carpet, smoothstep(-0.5f * kRoomBlur, 0.5f * kRoomBlur, floor_near - wall));
  return seen + room.softbox * kDaylight * room_window(d);
}

// What a smooth surface mirrors: the room with the light's softbox.
SHARED vec3 room_mirrored(Room room, vec3 direction) {
  float to_box = dot(direction, room.to_light);
  return room_radiance(room, direction) + room.softbox * smoothstep(0.90f, 0.97f, to_box);
}

// Irradiance / π on a surface of this normal, from all but the light: room_radiance() integrated, fitted to 3 %.
SHARED vec3 room_ambient(Room room, vec3 n) {
  vec3 from = vec3(1.0f, n.y, n.y * n.y);
  float window = max(0.017f + 0.008f * n.y - 0.022f * n.x - 0.048f * n.z + 0.032f * n.z * n.z, 0.0f);
  return room.sky * dot(vec3(0.190f, 0.371f, 0.174f), from) + room.horizon * dot(vec3(0.226f, 0.057f, -0.130f), from) +
         room.ground * dot(vec3(0.232f, -0.302f, 0.053f), from) + room.softbox * kDaylight * window;
}
