// The probe's housing as a signed distance, mm, in the probe's frame: a head that ends in the face, a grip, and the
// marker on the +x side. The plain shape is this project's own. Face and marker are where a real probe has them. All of
// it lies between probe_low and probe_high (box_of_probe() in sim/view/body/volume_view.cpp).

const float kHeadDepth = 26.0, kHeadHalfThickness = 9.0, kGripLength = 115.0, kLens = 2.5;

// Returns the distance beyond the face (< 0 within the head), and the distance beyond its lateral edge.
vec2 face_distance(vec2 p) {
  if (probe_shape.x == 0.0) return vec2(p.y, abs(p.x) - probe_shape.y);
  vec2 q = vec2(p.x, p.y + probe_shape.x);
  float r = length(q);
  return vec2(r - probe_shape.x, (abs(atan(q.x, q.y)) - probe_shape.y) * r);
}

float smooth_union(float a, float b, float radius) {
  float h = max(radius - abs(a - b), 0.0) / radius;
  return min(a, b) - h * h * radius * 0.25;
}

float marker_distance(vec3 p) {
  float edge = probe_shape.x == 0.0 ? probe_shape.y : probe_shape.x * sin(probe_shape.y);
  return length(p - vec3(edge + 1.0, -14.0, 0.0)) - 3.5;
}

float housing_distance(vec3 p) {
  const float rounding = 2.5;
  vec2 face = face_distance(p.xy);
  vec3 outside = vec3(max(face.x, -face.x - kHeadDepth), face.y - 1.0, abs(p.z) - kHeadHalfThickness) + rounding;
  float head = length(max(outside, 0.0)) + min(max(outside.x, max(outside.y, outside.z)), 0.0) - rounding;
  float along = clamp(-p.y, 20.0, kGripLength);
  float radius = mix(12.0, 16.0, smoothstep(20.0, 70.0, along)) - 3.0 * smoothstep(80.0, kGripLength, along);
  float grip = length(vec3(p.x, p.y + along, p.z * 1.15)) - radius;
  return smooth_union(head, grip * 0.85, 14.0);
}

float probe_distance(vec3 p) {
  return min(housing_distance(p), marker_distance(p));
}

// Returns the distance along a ray to the probe, mm; -1 where the ray misses it.
float meet_probe(vec3 origin, vec3 direction) {
  vec3 safe = mix(direction, vec3(1e-9), lessThan(abs(direction), vec3(1e-9)));
  vec3 a = (probe_low.xyz - origin) / safe, b = (probe_high.xyz - origin) / safe;
  vec3 low = min(a, b), high = max(a, b);
  float t = max(max(low.x, low.y), max(low.z, 0.0)), end = min(min(high.x, high.y), high.z);
  for (int i = 0; i < 64 && t < end; ++i) {
    float distance = probe_distance(origin + t * direction);
    if (distance < 0.1) return t;
    t += distance * 0.9;
  }
  return -1.0;
}

vec3 probe_normal(vec3 p) {
  const vec2 h = vec2(0.3, -0.3);
  return normalize(h.xyy * probe_distance(p + h.xyy) + h.yyx * probe_distance(p + h.yyx) +
                   h.yxy * probe_distance(p + h.yxy) + h.xxx * probe_distance(p + h.xxx));
}

vec3 probe_colour(vec3 p) {
  if (marker_distance(p) < 0.5) return vec3(0.30, 0.85, 0.45);
  return p.y > -kHeadDepth && face_distance(p.xy).x > -kLens ? vec3(0.24, 0.26, 0.29) : vec3(0.78, 0.80, 0.82);
}
