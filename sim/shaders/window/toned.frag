// A picture in the window whose white is another colour. The colour is a uniform and not the corners': llvmpipe of
// Mesa 22.3 confuses two varyings in tiles that a triangle without blending covers as a whole.
//
// Reads the picture. Writes the colour.
// Draw: triangles.
layout(binding = 0) uniform sampler2D picture;
layout(location = 0) uniform vec4 white;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 colour;

void main() {
  colour = white * texture(picture, uv);
}
