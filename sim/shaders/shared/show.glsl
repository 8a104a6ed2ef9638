// What the last of the stages that know a pixel's level do with it: they map it to grey or, with KEEP_SHOWN, mix it with
// the frame before (persistence) and keep it. With FILTERED, enhance.comp maps it to grey.

#if KEEP_SHOWN == 1
layout(std430, binding = 4) buffer Shown { float shown[]; };  // 1 + the compressed echo; 0 outside the fan
#endif
#if FILTERED == 0
layout(std430, binding = 3) writeonly buffer Image { uint image[]; };  // grey, grey, grey, 1 inside the fan; packed
#endif

void show(int pixel, float level, float white_db) {
  bool inside = level != kOutsideFan;
  float echo = compressed(level, white_db);
#if KEEP_SHOWN == 1
  echo = mix(echo, max(shown[pixel] - 1.0, 0.0), of_frame_before);
  shown[pixel] = inside ? 1.0 + echo : 0.0;
#endif
#if FILTERED == 0
  image[pixel] = inside ? pixel_of(echo) : 0u;
#endif
}
