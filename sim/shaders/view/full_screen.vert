// Full-screen pass: a triangle that covers the viewport.
//
// Reads nothing but gl_VertexID. Writes the position and the fragment's place in the viewport.
// Draw: one triangle (FullScreenTriangle, sim/gl/objects.h).
layout(location = 0) out vec2 uv;  // [0, 1] from the bottom left

void main() {
  uv = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
}
