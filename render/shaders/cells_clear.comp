// No particle is counted yet. glClearNamedBufferSubData takes longer than counting a million of them, on an H200.
layout(local_size_x = 64) in;
layout(std430, binding = 3) restrict writeonly buffer Counts { uvec4 counts[]; };
uniform int count;  // fours of them
void main() {
  uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
  if (index < uint(count)) counts[index] = uvec4(0u);
}
