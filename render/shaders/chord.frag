// A sphere's chord, added up by blending.
#include "chord_point.glsl"
flat in float center_depth;
flat in float weight;
layout(location = 0) out float chord;
void main() { chord = chord_at(ivec2(gl_FragCoord.xy), gl_PointCoord * 2.0 - 1.0, center_depth, weight); }
