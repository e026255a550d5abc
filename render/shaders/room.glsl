// A photographer's studio: soft sky, bright horizon, darker floor, one large light. GLSL and C++; pure functions.

// Radiances; to_light: unit, world.
struct Room {
  vec3 sky;
  vec3 horizon;
  vec3 ground;
  vec3 softbox;
  vec3 to_light;
};

// Radiance from a world direction (unit), without the light.
SHARED vec3 room_radiance(Room room, vec3 direction) {
  float up = direction.y;
  vec3 above = mix(room.horizon, room.sky, sqrt(clamp(up, 0.0f, 1.0f)));
  return up >= 0.0f ? above : mix(room.horizon, room.ground, smoothstep(0.0f, 0.55f, -up));
}

// What a smooth surface mirrors: the room with the light's softbox.
SHARED vec3 room_mirrored(Room room, vec3 direction) {
  float to_box = dot(direction, room.to_light);
  return room_radiance(room, direction) + room.softbox * smoothstep(0.90f, 0.97f, to_box);
}

// Irradiance / π on a surface of this normal, from all but the light.
SHARED vec3 room_ambient(Room room, vec3 normal) {
  vec3 middle = mix(room.horizon, 0.5f * (room.sky + room.ground), 0.5f);
  vec3 pole = normal.y >= 0.0f ? room.sky : room.ground;
  return mix(middle, pole, 0.75f * abs(normal.y));
}
