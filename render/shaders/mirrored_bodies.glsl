// What of the bodies the fluid's surface mirrors, as far as the picture shows it: a mirrored ray is followed over the opaque
// picture's depths. Where it leaves the picture, passes behind something or would meet a side that the picture does not show, the
// room is mirrored. Beyond the paper; fluid_look.frag has scene_depth and scene_color.
const int kRaySteps = 48;    // along the ray at most, the shorter the nearer to where it starts
const int kRayHalvings = 5;  // of the step in which it goes behind what the picture shows

// Pixel and 1/depth: straight lines in space are straight in these.
vec3 in_picture(vec3 eye) {
  float inverse = 1.0 / -eye.z;
  return vec3(((eye.xy * inverse / unproject.xy - unproject.zw) * 0.5 + 0.5) * picture.xy, inverse);
}

float scene_at(vec2 pixel) { return texelFetch(scene_depth, clamp(ivec2(pixel), ivec2(0), ivec2(picture.xy) - 1), 0).r; }

// To the neighbour along an axis that is nearer in depth: the other may be of another body.
vec3 scene_tangent(vec3 here, vec2 pixel, vec2 axis) {
  float ahead = scene_at(pixel + axis);
  float behind = scene_at(pixel - axis);
  bool forward = abs(ahead + here.z) < abs(behind + here.z);
  return forward ? eye_position(pixel + axis, ahead) - here : here - eye_position(pixel - axis, behind);
}

// here, way (unit): eye axes. Radiance, and how far it is known, 0–1.
vec4 mirrored_body(vec3 here, vec3 way) {
  float longest = way.z > 0.0 ? min(camera.w, 0.9 * -here.z / way.z) : camera.w;
  vec3 from = in_picture(here);
  vec3 to = in_picture(here + longest * way);
  vec2 run = to.xy - from.xy;
  vec2 rim = picture.xy * vec2(greaterThan(run, vec2(0.0)));
  vec2 shares = (rim - from.xy) / (run + vec2(lessThan(abs(run), vec2(1.0e-3))) * 1.0e9);
  to = mix(from, to, clamp(min(abs(shares.x), abs(shares.y)), 0.0, 1.0));

  int steps = int(clamp(0.25 * length(to.xy - from.xy), 1.0, float(kRaySteps)));
  float before = 0.0;
  float low = 0.0;
  float high = -1.0;
  float inverse_before = from.z;
  for (int i = 1; i <= steps; ++i) {
    float u = float(i) / float(steps);
    float s = u * mix(u, 1.0, 0.4);
    vec3 at = mix(from, to, s);
    float scene = scene_at(at.xy);
    float depth = 1.0 / at.z;
    // What it goes behind by more than it came on in this step it passes behind.
    float near = 2.0 * abs(depth - 1.0 / inverse_before) + 0.02 * depth;
    if (depth > scene && depth - scene < near) {
      low = before;
      high = s;
      break;
    }
    before = s;
    inverse_before = at.z;
  }
  if (high < 0.0) return vec4(0.0);
  for (int i = 0; i < kRayHalvings; ++i) {
    float middle = 0.5 * (low + high);
    vec3 at = mix(from, to, middle);
    if (at.z * scene_at(at.xy) < 1.0)
      high = middle;
    else
      low = middle;
  }
  vec3 at = mix(from, to, high);
  vec2 pixel = floor(at.xy) + 0.5;
  float scene = scene_at(pixel);
  float last_step = abs(1.0 / at.z - 1.0 / mix(from, to, low).z);
  float met = 1.0 - smoothstep(0.5, 1.0, abs(1.0 / at.z - scene) / (0.01 / at.z + 2.0 * last_step));
  vec3 place = eye_position(pixel, scene);
  vec3 normal = cross(scene_tangent(place, pixel, vec2(1.0, 0.0)), scene_tangent(place, pixel, vec2(0.0, 1.0)));
  float facing = -dot(normal, way) * inversesqrt(dot(normal, normal) + 1.0e-20);
  vec2 inward = min(at.xy, picture.xy - at.xy) * picture.w;
  float known = met * smoothstep(0.0, 0.1, facing) * smoothstep(0.0, 0.06, min(inward.x, inward.y));
  return vec4(texelFetch(scene_color, clamp(ivec2(pixel), ivec2(0), ivec2(picture.xy) - 1), 0).rgb, known);
}
