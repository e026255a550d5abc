// A particle's centre and ellipsoid from its neighbourhood (Yu & Turk 2013). GLSL and C++; pure functions.

const float kSmoothingShare = 0.9f;  // of the way to the mean (their λ)
const float kSmoothingFlat = 0.22f;  // of the reach: from a flat surface's particles to their mean

// Of ellipsoids, in particle radii. Along a flat surface, and in what is round: a particle inside that shows through a gap; a particle
// alone is the ball of its volume; the least that an ellipsoid is thick, which is what a sheet of one layer has.
const float kEllipsoidAlong = 2.4f;
const float kEllipsoidRound = 1.2f;
const float kEllipsoidThin = 0.9f;
const float kFullVariance = 0.15f;  // of the reach squared: a neighbourhood's variance where it is full
const float kFewNeighbours = 4.0f;  // in sum of weights, itself counting as one
/// Weights of neighbours from which a particle is as round as kEllipsoidRound says; below it is a ball of its volume.
const float kAccompanied = 2.0f;

// What lies on a wall. Half an ellipsoid with the volume of a ball of radius 1 that is 0.27 times as high as wide, as drops of water
// are on wood or enamel; a layer is as high as its volume over its area. In particle radii.
const float kLyingWide = 1.95f;
const float kLyingHigh = 0.53f;
const float kLayerHigh = 0.136f;  // times the weights of the neighbours in a plane
const float kLyingNear = 1.5f, kLyingFar = 2.2f;  // of the centre from the wall
const float kLyingFew = 9.0f, kLyingMany = 15.0f;  // weights between which a particle is one of a thicker layer

// Weighted moments of the ways to a particle's neighbours, itself among them. m
struct Neighbourhood {
  float weights;
  vec3 sum;
  vec3 square;
  vec3 mixed;  // xy, yz, zx
};

// At a share of the reach, below 1.
SHARED float neighbour_weight(float share) { return 1.0f - share * share * share; }

// Where the centre goes.
SHARED vec3 smoothing_step(Neighbourhood n, float reach) {
  if (n.weights <= 0.0f) return vec3(0.0f);
  // A particle of a flat surface would go inwards by a length that is known: without it, what sticks out goes in, what lies deep
  // comes out, and the surface as a whole stays. Inside, and in a thin sheet, means are near: no correction.
  vec3 way = n.sum / n.weights;
  float off = length(way);
  float flat_way = kSmoothingFlat * reach;
  float kept = smoothstep(0.3f * flat_way, 0.8f * flat_way, off) * flat_way / max(off, 1e-9f);
  return kSmoothingShare * (1.0f - kept) * way;
}

// Where its neighbours' mean is, from the particle.
SHARED vec3 neighbours_mean(Neighbourhood n) { return n.sum / max(n.weights, 1e-9f); }

// Share in which a particle lies on a wall that is so far from its centre. At the rim of a full vessel few are near, too, but they
// go on away from the wall, as `mean` says.
SHARED float lying_share(float weights, vec3 mean, vec3 normal, float away, float radius) {
  float mean_off = dot(mean, normal);
  return (1.0f - smoothstep(kLyingNear, kLyingFar, away / radius)) * (1.0f - smoothstep(kLyingFew, kLyingMany, weights)) *
         (1.0f - smoothstep(0.25f, 0.6f, mean_off / radius));
}

// m², about a centre on the wall.
SHARED mat3 lying_ellipsoid(float weights, vec3 normal, float radius) {
  float high = max(kLyingHigh, kLayerHigh * weights) * radius;
  float wide = kLyingWide * radius;
  mat3 flat_disc = mat3(wide * wide);
  float less = high * high - wide * wide;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) flat_disc[i][j] += less * normal[i] * normal[j];
  return flat_disc;
}

// m². Radii go with the variances, as theirs do; so no axes have to be found.
SHARED mat3 smoothing_ellipsoid(Neighbourhood n, float reach, float radius) {
  float round = mix(1.0f, kEllipsoidRound, smoothstep(1.0f, kAccompanied, n.weights));
  float ball = round * round * radius * radius;
  if (n.weights < kFewNeighbours) return mat3(ball);
  vec3 mean = n.sum / n.weights;
  float scale = 1.0f / (kFullVariance * reach * reach);
  vec3 d = (n.square / n.weights - mean * mean) * scale;
  vec3 m = (n.mixed / n.weights - mean * vec3(mean.y, mean.z, mean.x)) * scale;
  mat3 variance = mat3(d.x, m.x, m.z, m.x, d.y, m.y, m.z, m.y, d.z);
  // 1 where it is as wide in every direction.
  float third = (d.x + d.y + d.z) / 3.0f;
  float roundness = determinant(variance) / max(third * third * third, 1e-9f);
  float size = radius * mix(kEllipsoidAlong, kEllipsoidRound, smoothstep(0.7f, 0.95f, roundness));
  mat3 wide = size * size * (variance * variance) + mat3(kEllipsoidThin * kEllipsoidThin * radius * radius);
  // Few neighbours say little about a shape.
  float known = smoothstep(kFewNeighbours, 2.0f * kFewNeighbours, n.weights);
  return mat3(ball) * (1.0f - known) + wide * known;
}

// passes/splats.h, SplatShape.
struct EllipsoidOutline {
  vec3 outline;
  float depth_radius;
  vec2 tilt;
};

// Of the points p about `center` (eye axes, m, in front of the eye) with pᵀ matrix⁻¹ p = 1. To first order in its size over its
// distance.
SHARED EllipsoidOutline ellipsoid_outline(mat3 matrix, vec3 center) {
  // A point's place in the picture moves with its depth where it lies off the middle: that is a shear. Then a Cholesky
  // factor, whose rows are the two axes of the picture and the depth.
  float depth = -center.z;
  vec3 x = vec3(1.0f, 0.0f, center.x / depth);
  vec3 y = vec3(0.0f, 1.0f, center.y / depth);
  vec3 away = vec3(0.0f, 0.0f, -1.0f);
  vec3 mx = matrix * x;
  vec3 my = matrix * y;
  EllipsoidOutline shape;
  shape.outline.x = sqrt(max(dot(x, mx), 1e-12f));
  shape.outline.y = dot(y, mx) / shape.outline.x;
  shape.outline.z = sqrt(max(dot(y, my) - shape.outline.y * shape.outline.y, 1e-12f));
  shape.tilt.x = dot(away, mx) / shape.outline.x;
  shape.tilt.y = (dot(away, my) - shape.tilt.x * shape.outline.y) / shape.outline.z;
  shape.depth_radius = sqrt(max(dot(away, matrix * away) - dot(shape.tilt, shape.tilt), 1e-12f));
  return shape;
}
