// What the images' pixels read of the scan lines.

layout(binding = 0) uniform sampler2D scan;  // a row a line, image after image: E, R, I, 0

// E and R of an image at a line and a sample, bilinear.
vec2 terms_at(vec2 line_and_sample, int image) {
  ivec2 last = ivec2(samples, lines) - 1;
  vec2 position = clamp(line_and_sample.yx, vec2(0.0), vec2(last));
  ivec2 low = ivec2(position), high = min(low + 1, last);
  vec2 f = position - vec2(low);
  low.y += image * lines;
  high.y += image * lines;
  return mix(mix(texelFetch(scan, low, 0).xy, texelFetch(scan, ivec2(high.x, low.y), 0).xy, f.x),
             mix(texelFetch(scan, ivec2(low.x, high.y), 0).xy, texelFetch(scan, high, 0).xy, f.x), f.y);
}
