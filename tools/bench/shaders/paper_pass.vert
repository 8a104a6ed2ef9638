// Pass k draws vertices 2k and 2k + 1: a line across row k of the targets.
layout(location = 6) uniform int samples;
layout(location = 0) flat out int k;

void main() {
  k = gl_VertexID >> 1;
  gl_Position = vec4(bool(gl_VertexID & 1) ? 1.0 : -1.0, (2.0 * float(k) + 1.0) / float(samples) - 1.0, 0.0, 1.0);
}
