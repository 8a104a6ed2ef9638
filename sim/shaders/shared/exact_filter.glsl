// Trilinear filtering with weights in single precision. A device's own filter may have weights of as few as 8 bits,
// which shows in differences between near samples. `insonate-bench filter` measures it.

vec4 weighed(sampler3D texels, ivec3 low, ivec3 high, vec3 f) {
  vec4 row_00 = mix(texelFetch(texels, low, 0), texelFetch(texels, ivec3(high.x, low.yz), 0), f.x);
  vec4 row_10 = mix(texelFetch(texels, ivec3(low.x, high.y, low.z), 0),
                    texelFetch(texels, ivec3(high.xy, low.z), 0), f.x);
  vec4 row_01 = mix(texelFetch(texels, ivec3(low.xy, high.z), 0),
                    texelFetch(texels, ivec3(high.x, low.y, high.z), 0), f.x);
  vec4 row_11 = mix(texelFetch(texels, ivec3(low.x, high.yz), 0), texelFetch(texels, high, 0), f.x);
  return mix(mix(row_00, row_10, f.y), mix(row_01, row_11, f.y), f.z);
}

// As textureLod(texels, at, 0.0) of a texture with clamped edges ...
vec4 exact_to_edge(sampler3D texels, vec3 at) {
  ivec3 last = textureSize(texels, 0) - 1;
  vec3 position = clamp(at * vec3(last + 1) - 0.5, vec3(0.0), vec3(last));
  ivec3 low = ivec3(position);
  return weighed(texels, low, min(low + 1, last), position - vec3(low));
}

// ... and of a repeating texture whose sides are powers of two.
vec4 exact_repeating(sampler3D texels, vec3 at) {
  ivec3 last = textureSize(texels, 0) - 1;
  vec3 position = at * vec3(last + 1) - 0.5, below = floor(position);
  ivec3 low = ivec3(below);
  return weighed(texels, low & last, (low + 1) & last, position - below);
}
