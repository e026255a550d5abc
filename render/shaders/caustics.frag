// A point's light, spread over its neighbours.
flat in vec2 flux;
layout(location = 0) out vec2 sums;
void main() {
  vec2 off = gl_PointCoord * 2.0 - 1.0;
  float near = max(1.0 - dot(off, off), 0.0);
  sums = flux * (near * near);
}
