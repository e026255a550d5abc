// Shares of four fluids, added up by blending.
#include "mixing.glsl"
flat in vec3 center;
flat in float reach;
flat in int channel;
layout(location = 0) out vec4 shares;
void main() { shares = share_at(ivec2(gl_FragCoord.xy), center, reach) * vec4(equal(ivec4(0, 1, 2, 3), ivec4(channel))); }
