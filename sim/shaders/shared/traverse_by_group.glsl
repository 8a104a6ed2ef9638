// Traverses one line per work group. Its invocations take neighbouring samples, one stretch of GROUP samples at a time.
// What depends on the samples before is found by scans (prefix sums) over the stretch and carried into the next
// stretch. Each sample fetches the ends of its own reflection length. Its neighbours fetch the same ones at the same
// time, which a card's texture cache serves.
//
// Invocations of a group wait for each other. All of them must reach each barrier, so the conditions of the loops
// around a barrier are the same for all. Sample k belongs to the same invocation in each slice plane, so that the sums
// over these need no barrier.

const int kLast = GROUP - 1;
shared float changes[GROUP];  // of ln I, from the stretch's start to behind each sample
shared vec2 deflections[GROUP];

// A level joins neighbouring parts of the stretch, twice as long as those of the level before. It adds the value of the
// front part's last sample to each sample of the back part. A level writes nothing that it reads. Rounding keeps
// numbers in order, so these sums never rise from sample to sample if no addend is positive.
void scan_changes(int me, float change) {
  barrier();  // until all have read the sums of the stretch before
  changes[me] = change;
  for (int part = 1; part < GROUP; part *= 2) {
    barrier();
    if ((me & part) != 0) changes[me] += changes[(me & -part) - 1];
  }
  barrier();
}

// The same for a rotation, which decays with distance. The first sample adds what is left of `before`, the rotation in
// front of the stretch.
void scan_deflections(int me, vec2 deflection, vec2 before) {
  float kept = deflection_kept;  // from the front part's last sample to this one
  float kept_over_part = deflection_kept;
  barrier();
  deflections[me] = me == 0 ? before * deflection_kept + deflection : deflection;
  for (int part = 1; part < GROUP; part *= 2) {
    barrier();
    if ((me & part) != 0) {
      deflections[me] += deflections[(me & -part) - 1] * kept;
      kept *= kept_over_part;
    }
    kept_over_part *= kept_over_part;
  }
  barrier();
}

void traverse_line(int slice_plane, int index) {
  place_line(slice_plane, index);
  int me = int(gl_LocalInvocationID.x), row = index * samples, end = starts() ? samples : 0, first = 0;
  LogIntensity arriving = arriving_first(medium(0.0));  // at the stretch's first sample
  vec2 deflection = vec2(0.0);                          // rotation behind its last sample
  for (; first < end && (SKIPPING == 0 || is_heard(arriving)); first += GROUP) {
    int k = first + me;
    float position = float(k);
    Sample met = Sample(0.0, 0.0, 0.0, vec2(0.0), vec2(0.0));  // stays so behind the line's end
    if (k < samples) {
      met = sample_at(position, medium(position), medium(position - half_reflection_length),
                      medium(position + half_reflection_length));
      ++traversed;
    }
#if EDGE_SHADOW == 1
    scan_deflections(me, met.deflection, deflection);
    met.change += change_by(deflections[me]);
    deflection = deflections[kLast];
#endif
    scan_changes(me, met.change);
    LogIntensity log_intensity = arriving;
    if (me > 0) log_intensity = changed(arriving, changes[me - 1]);
    if (k < samples) put(slice_plane, row, k, met, log_intensity);
    arriving = changed(arriving, changes[kLast]);
  }
  put_silent(slice_plane, row, first + me, GROUP);
}
