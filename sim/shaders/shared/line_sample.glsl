// A scan line of model S and what sound meets at a sample of it: reflection coefficient, transmission, the scatterers'
// echo. The file that includes this one traverses the lines.
//
// Fetches from the volume dominate the cost, so this code makes as few as the sampling allows. The result has one row
// per line: invocations that each write along a row stay in the processor's cache, while one column each would touch
// one page per step. The result is a buffer, as between all stages: a software renderer takes several times as long to
// store to an image.

#include "shared/simulation_parameters.h"
#include "shared/least_echo.glsl"
#include "shared/acoustic_volume.glsl"
#include "shared/exact_filter.glsl"

layout(binding = 1) uniform sampler3D scatterers;  // complex, variance 1 at the lattice's points; with STORED_SPECKLE S
layout(binding = 3) uniform isamplerBuffer scattered;     // with WAVES: of scatter.comp
layout(binding = 4) uniform samplerBuffer scatterer_scale;  // and what its whole numbers are multiplied by, by sample
layout(binding = 2) uniform samplerBuffer in_air;  // of a line that does not meet the body, by sample: I, R; with WAVES then
                                                   // the mirrored part and the square of the rough one
layout(std430, binding = 1) buffer Scan { vec4 scan[]; };  // one row per line: I, R, scatterers' echo (re, im); with
                                                            // WAVES I, scattered power, echo (re, im)

// A line and the directions beside it, computed in double precision for each pose. Sums of single-precision products
// here would move samples by a thousandth of a voxel, which shows at the surface of gas.
struct Line {
  vec4 start, along;        // in the volume's texture: sample 0, step to the next; start.w and along.w: first and last
                            // sample that may lie in the body, first > last if none does
  vec4 lateral, elevation;  // half the reflection length to either side; lateral.w: the slice plane's weight;
                            // elevation.w: 1 for the line whose results those that meet no body take over
  vec4 lattice_start, lattice_along;  // in the scatterers' lattice
  vec4 beside, lattice_beside;        // with ELEVATION_FOCUS: step to the slice plane per mm of the slice's thickness
};
#if KEEP_MIDDLE == 1
layout(std430, binding = 3) writeonly buffer Middle { vec2 middle[]; };  // one row per line: I, R of the middle plane
#endif
// Plane by plane; within each, one slice plane after the other.
layout(std430, binding = 0) readonly buffer ScanLines { Line scan_lines[]; };
layout(std430, binding = 2) buffer Counters { uint samples_traversed, normals_taken; };

// Where the ends of the reflection length lie. Ends that coincide with those of the next samples are fetched once.
const int kEdgesAtSamples = 2;  // l = 2 dr: on the neighbouring samples
const int kEdgesAtMiddles = 1;  // l = dr: halfway between samples, as in the paper
const int kEdgesAnywhere = 0;

const float kMeanCosine = 0.5;           // |d . n| over all directions, for interfaces too weak to need a normal
const float kLn10 = 2.302585093;
// As in sim/tissue/acoustic_volume.h: the level in hundredths of a dB, and 10^(level / 1000).
const float kSilentEchogenicity = -5999.5;
#if WAVES == 1
const float kSilentAmplitude = 1.00057581e-3;  // 10^(level / 2000)
#else
const float kSilentAmplitude = 1.00115195e-6;
#endif
// ln 10^-33. Intensity is a factor of each echo at least once, and echoes below 10^-30 count as 0 (least_echo.glsl).
// The planes of a slice add up to one echo, so each is known to a thousandth of that limit.
const float kMinLogIntensity = -76.0;

Line line;
int scattered_row;  // index of the line's first sum in `scattered`
uint traversed = 0u, normals = 0u;  // by this invocation

// Returns the number of lines to traverse: those of all planes, or 1 for the line in air.
int line_count() { return min(planes * lines, scan_lines.length() / SLICE_PLANES); }

void place_line(int slice_plane, int index) {
  int stride = min(lines, line_count());
  int placed = index + (index / stride * (SLICE_PLANES - 1) + slice_plane) * stride;
  line = scan_lines[placed];
  scattered_row = index * (samples + 1);
}

bool starts() { return line.start.w <= line.along.w; }

// Positions along the line, counted in samples. With ELEVATION_FOCUS the planes bend as the slice's thickness does.
float depth(float k) { return r_min_mm + (k + 0.5) * dr_mm; }
#if ELEVATION_FOCUS == 1
float thickness_mm(float k) {
  float spread = slice_spread * (depth(k) - elevation_focus_mm);
  return sqrt(slice_thickness_mm * slice_thickness_mm + spread * spread);
}
vec3 place(float k) { return line.start.xyz + k * line.along.xyz + thickness_mm(k) * line.beside.xyz; }
vec3 lattice_place(float k) {
  return line.lattice_start.xyz + k * line.lattice_along.xyz + thickness_mm(k) * line.lattice_beside.xyz;
}
#else
vec3 place(float k) { return line.start.xyz + k * line.along.xyz; }
vec3 lattice_place(float k) { return line.lattice_start.xyz + k * line.lattice_along.xyz; }
#endif

vec2 voxel(vec3 at) {
#if EXACT_FILTER == 1
  return exact_to_edge(acoustic_volume, at).rg * 32767.0;
#else
  return textureLod(acoustic_volume, at, 0.0).rg * 32767.0;
#endif
}

// Coupling gel replaces the air between the face and the skin, up to the thickness of its layer.
vec2 with_gel(vec2 voxel, float r) { return r < coupling_depth_mm ? mix(voxel, kGel, gel_share(voxel.x)) : voxel; }

struct Medium { float hu, impedance, absorption, echogenicity; };

// Returns the medium at a position along the line, counted in samples.
Medium medium(float k) {
  vec2 here = kOutside;
  if (k >= line.start.w && k <= line.along.w) here = voxel(place(k));
  here = with_gel(here, depth(k));
  vec2 known = impedance_and_absorption(here.x);
  return Medium(here.x, known.x, known.y, here.y);
}

float hu_at(vec3 at, float r) { return with_gel(voxel(at), r).x; }

// ln(1 - alpha) without the cancellation in 1 - alpha. Weak interfaces take its series, strong ones
// 4 Z1 Z2 / (Z1 + Z2)^2.
float log_transmission(float alpha, float z1, float z2) {
  if (alpha < 0.03) return -alpha * (1.0 + alpha * (0.5 + alpha * (1.0 / 3.0 + alpha * 0.25)));
  return log(4.0 * z1 * z2 / ((z1 + z2) * (z1 + z2)));
}

// Trilinear interpolation between independent numbers has less variance between lattice points than at them. Division
// by the root of the variance that the weights leave keeps the lattice from showing in the speckle.
vec2 scatterer(vec3 lattice) {
  vec3 f = fract(lattice * vec3(textureSize(scatterers, 0)) - 0.5);
  vec3 kept = f * f + (1.0 - f) * (1.0 - f);
#if EXACT_FILTER == 1
  vec2 stored = exact_repeating(scatterers, lattice).rg;
#else
  vec2 stored = textureLod(scatterers, lattice, 0.0).rg;
#endif
  return stored * (kScattererScale * inversesqrt(kept.x * kept.y * kept.z));
}

// The change of density around a sample. Its gradient has the direction of the impedance's gradient, so that no fetch
// from the tissue table is needed.
struct Surroundings {
  vec4 beside;  // HU at half the reflection length: to both sides in the plane, and in elevation
  float along;  // difference over the reflection length along the line
};

// Takes differences beside the line; the difference along the line is known from the traversal.
Surroundings surroundings(float k, float along) {
  vec3 at = place(k);
  float r = depth(k);
  return Surroundings(vec4(hu_at(at + line.lateral.xyz, r), hu_at(at - line.lateral.xyz, r),
                           hu_at(at + line.elevation.xyz, r), hu_at(at - line.elevation.xyz, r)), along);
}

// |cos| of the angle between the beam and the normal of the interface.
float incidence(Surroundings around) {
  vec2 across = around.beside.xz - around.beside.yw;
  return abs(around.along) * inversesqrt(max(around.along * around.along + dot(across, across), 1e-30));
}

#if WAVES == 1
// Returns n of sim/model/waves.h; i without speckle.
vec2 scatterers_at(int k) {
#if SPECKLE == 1
  ivec2 before = texelFetch(scattered, scattered_row + k).xy, behind = texelFetch(scattered, scattered_row + k + 1).xy;
  ivec2 of_before = (before - (before << 16 >> 16)) >> 16, of_behind = behind << 16 >> 16;
  return vec2(of_before + of_behind) * texelFetch(scatterer_scale, k).x;
#else
  return vec2(0.0, 1.0);
#endif
}

// Returns the amplitude of scatterers of the medium, relative to liver's.
float scatterer_amplitude(Medium here) {
  return max(exp(here.echogenicity * (kLn10 / 2000.0)) - kSilentAmplitude, 0.0);
}
#endif

// Returns the complex amplitude of the scatterers at a sample of the paper's model.
vec2 scatterers_echo(float k, Medium here) {
#if STORED_SPECKLE == 1
#if EXACT_FILTER == 1
  return vec2(exact_to_edge(scatterers, lattice_place(k)).r, 0.0);
#else
  return vec2(textureLod(scatterers, lattice_place(k), 0.0).r, 0.0);
#endif
#else
  float above_silence = max(here.echogenicity - kSilentEchogenicity, 0.0);
  vec2 echo = vec2(kSilentAmplitude * (exp(above_silence * (kLn10 / 1000.0)) - 1.0), 0.0);
  if (SPECKLE == 1) echo = echo.x * scatterer(lattice_place(k));
  return echo;
#endif
}

// Returns the share of sound that an interface returns although it may be the surface of gel that touches nothing
// (sim/tissue/coupling.h).
float returned_by_gel(float k, Medium behind) {
  bool ends_here = coupling_depth_mm > half_reflection_length * dr_mm + kMinGel_mm &&
                   depth(k - half_reflection_length) < coupling_depth_mm &&
                   depth(k + half_reflection_length) >= coupling_depth_mm;
  return ends_here ? mix(1.0, kFreeGelShare, gel_share(behind.hu)) : 1.0;
}

// What sound meets at a sample, whatever intensity arrives there.
struct Sample {
  float alpha, cosine;  // of the interface
  float change;         // of ln I, without the loss by refraction
  vec2 deflection;      // rotation of the sound's direction by refraction, in units of kDeflection_rad
  vec2 echo;            // of the scatterers; with WAVES their amplitude, and the interface's q
};

float absorbed(Medium here) {
  float below = max(kEndless_db - 0.01 * here.echogenicity, 0.0);
  float by_end = kEndAbsorption * below * below;  // sim/tissue/acoustic_volume.h
  return (ABSORPTION == 1 ? here.absorption + by_end : by_end) * absorption_per_sample;
}

// Computes sample k from the media at the sample and at the ends of the reflection length before and behind it.
Sample sample_at(float k, Medium here, Medium before, Medium behind) {
  Sample met;
  met.alpha = (behind.impedance - before.impedance) / (behind.impedance + before.impedance);  // (1)
  met.alpha *= met.alpha;
  met.cosine = kMeanCosine;
#if EDGE_SHADOW == 1
  Surroundings around = surroundings(k, behind.hu - before.hu);
  vec4 soft = clamp(around.beside, kMinRefracting_hu, kMaxRefracting_hu);
  vec4 log_speed = kLogSpeedBelowWater * min(soft, 0.0) + kLogSpeedAboveWater * max(soft, 0.0);
  met.deflection = (log_speed.xz - log_speed.yw) * deflection_per_step;
#endif
  if (met.alpha > least_alpha_with_normal) {
#if EDGE_SHADOW == 0
    Surroundings around = surroundings(k, behind.hu - before.hu);
#endif
    met.cosine = incidence(around);
    ++normals;
  }
  float transmitted = log_transmission(met.alpha, before.impedance, behind.impedance);
  met.change = reflection_exponent * transmitted - absorbed(here);  // (5)
#if WAVES == 1
  met.cosine = pow(met.cosine, specular_exponent) * returned_by_gel(k, behind);
  float squared = met.alpha * met.alpha, weak = 0.5 * blend;
  float mirrored = sqrt(met.alpha * met.cosine) * squared / max(squared + weak * weak, kMinEcho);
  met.echo = vec2(scatterer_amplitude(here), behind.impedance < before.impedance ? -mirrored : mirrored);
#else
  met.echo = scatterers_echo(k, here);
#endif
  return met;
}

// Returns the change of ln I where sound that refraction has rotated by `deflection` leaves the line.
float change_by(vec2 deflection) {
  float square = dot(deflection, deflection), to_the_fourth = square * square;
  return -2.0 * to_the_fourth / (2.0 + to_the_fourth) * deflection_loss;
}

// ln of the intensity that arrives at a sample, as a compensated (Kahan) sum. Otherwise thousands of small losses would
// add up to a larger error than is allowed.
struct LogIntensity { float value, excess; };

// The first sample lies half a step behind the face.
LogIntensity arriving_first(Medium here) { return LogIntensity(-0.5 * absorbed(here), 0.0); }

LogIntensity changed(LogIntensity log_intensity, float change) {
  precise float term = change - log_intensity.excess;
  precise float value = min(log_intensity.value + term, log_intensity.value);  // I never rises
  precise float excess = (value - log_intensity.value) - term;
  return LogIntensity(value, excess);
}

bool is_heard(LogIntensity log_intensity) { return log_intensity.value > kMinLogIntensity; }

// Stores a sample; the planes of the slice add up by their weights. Reverberation needs the middle plane alone: layers
// that lie in different planes hold no sound between them.
// With WAVES the value is I, scattered power, the mirrored part of e and the square of the rough one, which the last
// plane makes e. The line in air stands for many lines, each with scatterers of its own.
void put(int slice_plane, int row, int k, vec4 value) {
#if KEEP_MIDDLE == 1 && WAVES == 0
  if (slice_plane == SLICE_PLANES / 2) middle[row + k] = value.xy;
#endif
#if SLICE_PLANES > 1
  value *= line.lateral.w;
  if (slice_plane > 0) value += scan[row + k];
#endif
#if WAVES == 1
  if (slice_plane == SLICE_PLANES - 1 && line.elevation.w == 0.0)
    value.zw = vec2(kMirrorShare * value.z, 0.0) + sqrt(value.w) * scatterers_at(k);
#endif
  scan[row + k] = value;
}

// Stores what a sample sends back of the intensity that arrives.
void put(int slice_plane, int row, int k, Sample met, LogIntensity log_intensity) {
  float intensity = is_heard(log_intensity) ? exp(log_intensity.value) : 0.0;
  float heard = intensity > kMinIntensity ? intensity : 0.0;
  float reflection = met.alpha * heard * heard * met.cosine;  // (3)
  if (reflection < kMinEcho) reflection = 0.0;
#if WAVES == 1
#if TWO_WAY == 1
  float arriving = heard;
#else
  float arriving = intensity > kMinEcho ? sqrt(intensity) : 0.0;
#endif
  float scattered_amplitude = blend_amplitude * met.echo.x * arriving;
  float mirrored = heard * met.echo.y, rough = kRoughShare * mirrored + scattered_amplitude;
#if KEEP_MIDDLE == 1
  if (slice_plane == SLICE_PLANES / 2) middle[row + k] = vec2(intensity, reflection);
#endif
  float beside = line.elevation.w > 0.0 ? reflection : scattered_amplitude * scattered_amplitude;
  put(slice_plane, row, k, vec4(intensity, beside, mirrored, rough * rough));
#else
  put(slice_plane, row, k, vec4(intensity, reflection, met.echo));
#endif
}

// Stores sample k and every `step`th sample behind it, where no sound arrives. As far as the body extends, such samples
// still scatter in the apertures of the lines beside this one.
void put_silent(int slice_plane, int row, int k, int step) {
#if WAVES == 0
  for (int end = int(min(line.along.w + 1.0, float(samples))); k < end; k += step)
    put(slice_plane, row, k, vec4(0.0, 0.0, scatterers_echo(float(k), medium(float(k)))));
#endif
  for (; k < samples; k += step) {
#if WAVES == 1
    vec4 air = starts() ? vec4(0.0) : texelFetch(in_air, k);
    put(slice_plane, row, k, vec4(air.x, 0.0, air.zw));
#if KEEP_MIDDLE == 1
    if (slice_plane == SLICE_PLANES / 2) middle[row + k] = air.xy;
#endif
#else
    put(slice_plane, row, k, vec4(starts() ? vec2(0.0) : texelFetch(in_air, k).xy, 0.0, 0.0));
#endif
  }
}
