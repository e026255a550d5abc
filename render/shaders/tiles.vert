// The tiles of the picture that fluid may cover (passes/splats.h).
layout(location = 0) in vec2 corner;  // clip space
void main() { gl_Position = vec4(corner, 0.0, 1.0); }
