// The window's shapes: passes each corner on.
//
// Reads corners as app/panels/canvas.cpp stores them. Writes the position, and what lies between the corners.
// Draw: triangles.
layout(location = 0) in vec2 position;  // clip space
layout(location = 1) in vec2 corner_uv;
layout(location = 2) in vec4 corner_colour;

layout(location = 0) out vec2 uv;
layout(location = 1) out vec4 tint;

void main() {
  uv = corner_uv;
  tint = corner_colour;
  gl_Position = vec4(position, 0.0, 1.0);
}
