// A texture in the window, tinted: letters and thin lines.
//
// Reads the texture. Writes the colour.
// Draw: triangles.
layout(binding = 0) uniform sampler2D letters;

layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 tint;

layout(location = 0) out vec4 colour;

void main() {
  colour = tint * texture(letters, uv);
}
