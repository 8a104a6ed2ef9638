// Traverses one line per invocation, from the face into the depth, because the intensity at a sample depends on all
// samples before it.

void traverse_line(int slice_plane, int index) {
  place_line(slice_plane, index);
  int row = index * samples, end = starts() ? samples : 0, k = 0;
  Medium here = medium(0.0), before = medium(-half_reflection_length);
  LogIntensity log_intensity = arriving_first(here);
#if EDGE_SHADOW == 1
  vec2 deflection = vec2(0.0);
#endif
  for (; k < end && (SKIPPING == 0 || is_heard(log_intensity)); ++k) {
    float position = float(k);
    Medium next = medium(position + 1.0), behind = next;
    if (EDGES_AT != kEdgesAtSamples) behind = medium(position + half_reflection_length);
    if (EDGES_AT == kEdgesAnywhere) before = medium(position - half_reflection_length);
    Sample met = sample_at(position, here, before, behind);
    put(slice_plane, row, k, met, log_intensity);
#if EDGE_SHADOW == 1
    deflection = deflection * deflection_kept + met.deflection;
    met.change += change_by(deflection);
#endif
    log_intensity = changed(log_intensity, met.change);
    before = behind;
    if (EDGES_AT == kEdgesAtSamples) before = here;
    here = next;
  }
  traversed += uint(k);
  put_silent(slice_plane, row, k, 1);
}
