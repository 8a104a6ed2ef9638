// A picture in the window, as it is.
//
// Reads the picture. Writes the colour.
// Draw: triangles.
layout(binding = 0) uniform sampler2D picture;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 colour;

void main() {
  colour = texture(picture, uv);
}
