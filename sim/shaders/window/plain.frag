// A part of the window in plain colour: panels and lines. It is apart from tinted.frag because a software renderer
// needs five times as long where a texture is read.
//
// Reads nothing. Writes the colour.
// Draw: triangles.
layout(location = 1) in vec4 tint;

layout(location = 0) out vec4 colour;

void main() {
  colour = tint;
}
