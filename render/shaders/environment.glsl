// The room that the frame stands in.
#include "frame_block.glsl"
#include "shared.glsl"
#include "room.glsl"

Room room() { return Room(sky.rgb, horizon.rgb, ground.rgb, softbox.rgb, to_light_world.xyz); }
vec3 studio(vec3 direction) { return room_radiance(room(), direction); }
vec3 mirrored(vec3 direction) { return room_mirrored(room(), direction); }
vec3 ambient_light(vec3 normal) { return room_ambient(room(), normal); }
