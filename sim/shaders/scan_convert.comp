// Backward warp from the lines to the picture. Where each pixel lies among the lines is worked out once per probe and
// depth, so this stage knows no probe.

layout(local_size_x = 16, local_size_y = 4) in;

layout(binding = 0) uniform sampler2D echoes;
layout(binding = 1) uniform sampler2D line_and_sample;  // per pixel; line below -1 outside the fan
layout(binding = 0, rgba32f) writeonly uniform image2D picture;  // R, T, S, 1 inside the fan

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(picture)))) return;
  vec2 position = texelFetch(line_and_sample, pixel, 0).xy;
  vec4 value = vec4(0.0);
  if (position.x > -1.0)
    value = vec4(textureLod(echoes, (position + 0.5) / vec2(textureSize(echoes, 0)), 0.0).xyz, 1.0);
  imageStore(picture, pixel, value);
}
