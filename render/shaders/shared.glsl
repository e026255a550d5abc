// What makes a file of shared maths GLSL; the C++ side is render/shader_math.h.
#define SHARED
