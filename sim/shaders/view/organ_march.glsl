// The march through skin, organs and bone for the volume view. It reads the tissue and body textures and the distances
// between blocks. The C++ side defines VOXELS_PER_BLOCK, the side of a block in voxels. To be included behind
// volume_ray.glsl.

layout(binding = 4) uniform usampler3D block_distance;  // blocks to the nearest one where something changes

// Returns the gradient of the opacity by central differences over one voxel, per patient mm.
vec3 opacity_gradient(vec3 at) {
  vec3 reach = 1.0 / vec3(textureSize(body, 0)), change;
  for (int axis = 0; axis < 3; ++axis) {
    vec3 aside = vec3(axis == 0, axis == 1, axis == 2) * reach;
    change[axis] = textureLod(body, at + aside, 0.0).x - textureLod(body, at - aside, 0.0).x;
  }
  return transpose(mat3(tissue_from_patient)) * (change / reach);
}

// The state of a ray on its way through the patient.
struct March {
  vec3 box_origin, box_direction;  // in coordinates of the tissue texture; direction per mm
  float t;                         // distance from the eye, mm
  float before, t_before;          // share of the body at the previous sample, -1 for none yet, and its t
  float here;                      // share of the body at t
  bool in_organ;
  vec2 light;  // of the organ's surface where the ray entered the organ
};

const int kNothing = 0, kSkin = 1, kOrgan = 2;

// Advances until the ray meets the skin or an organ, or `stop`, and returns which. The shading of what it meets is kept
// out of this loop: a software renderer runs all code of a loop's body for all samples, whatever its branches select.
int march_to_event(inout March march, float stop) {
  vec3 blocks_per_uv = vec3(textureSize(body, 0)) / float(VOXELS_PER_BLOCK);
  vec3 safe = mix(march.box_direction, vec3(1e-9), lessThan(abs(march.box_direction), vec3(1e-9)));
  vec3 block_origin = march.box_origin * blocks_per_uv, per_block = 1.0 / (safe * blocks_per_uv);
  bvec3 forward = greaterThan(safe, vec3(0.0));
  ivec3 last_block = textureSize(block_distance, 0) - 1;

  // The bounds of both loops are guards far above what is needed.
  for (int i = 0; i < 4096; ++i) {
    vec3 uv;
    for (int leap = 0; leap < 1024; ++leap) {  // skips blocks in which nothing changes
      uv = march.box_origin + march.t * march.box_direction;
      ivec3 block = clamp(ivec3(uv * blocks_per_uv), ivec3(0), last_block);
      int empty = int(texelFetch(block_distance, block, 0).x);
      if (empty == 0) break;
      vec3 exits = (vec3(block + mix(ivec3(1 - empty), ivec3(empty), forward)) - block_origin) * per_block;
      march.t = max(min(min(exits.x, exits.y), exits.z), march.t) + 0.02;
      if (march.t >= stop) break;
    }
    if (march.t >= stop) return kNothing;

    vec2 solid_and_body = textureLod(body, uv, 0.0).xy;
    march.here = solid_and_body.y;
    if (march.before >= 0.0 && (march.before - 0.5) * (march.here - 0.5) < 0.0 && skin > 0.0) return kSkin;
    march.before = march.here;
    march.t_before = march.t;

    vec4 organ = textureLod(tissue, uv, 0.0);
    float coverage = show_organs == 1 ? smoothstep(0.35, 0.65, organ.a) : 0.0;
    if (coverage > 0.0 && !march.in_organ) return kOrgan;
    if (coverage > 0.0) {
      float opacity = coverage * (1.0 - pow(1.0 - min(solid_and_body.x / organ.a, 0.999), step_mm));
      composite(organ.rgb / organ.a * march.light.x + 0.10 * march.light.y, opacity);
      if (sum.a >= kOpaque) return kNothing;
    }
    march.in_organ = coverage > 0.0;
    // Smoothing has spread every edge over two voxels, so a step of a whole voxel is safe where there is nothing.
    march.t += organ.a == 0.0 && (march.here == 0.0 || march.here == 1.0) ? max(step_mm, voxel_mm) : step_mm;
  }
  return kNothing;
}

// Composites the end of the CT where it cuts a body that is closed: what is within stays hidden.
void composite_end(March march, vec3 direction) {
  vec3 at = march.box_origin + march.t * march.box_direction, from_middle = abs(at - 0.5);
  float farthest = max(max(from_middle.x, from_middle.y), from_middle.z);
  vec3 face = vec3(greaterThanEqual(from_middle, vec3(farthest)));
  vec2 light = lighting(facing(transpose(mat3(tissue_from_patient)) * face, direction), direction);
  composite(kSkinColour * light.x, 1.0);
}

// Advances to `stop`, and composites the skin and the organs on the way.
void march_to(inout March march, vec3 direction, float stop) {
  bool enters = skin >= 1.0 && march.before < 0.0 && march.t > 0.0 && march.t < stop;
  for (bool todo = enters; todo; todo = false)
    if (textureLod(body, march.box_origin + march.t * march.box_direction, 0.0).y > 0.5) composite_end(march, direction);
  for (int i = 0; i < 256 && march.t < stop && sum.a < kOpaque; ++i) {
    int event = march_to_event(march, stop);
    float t_event = event == kSkin ? mix(march.t_before, march.t, (0.5 - march.before) / (march.here - march.before))
                                   : march.t;
    vec3 at = march.box_origin + t_event * march.box_direction;
    vec3 normal = facing(event == kSkin ? smooth_gradient(at) : opacity_gradient(at), direction);
    if (event == kSkin) {
      // The skin looks like glass: more opaque where it turns away from the viewer, less when seen from within.
      float rim = 1.0 - abs(dot(normal, direction));
      float side = march.here > march.before ? 1.0 : 0.5;
      vec2 light = lighting(normal, direction);
      composite(kSkinColour * light.x + 0.15 * light.y, mix(skin, max(skin, 0.7), rim * rim) * side);
      march.before = march.here;
    } else if (event == kOrgan) {
      march.light = lighting(normal, direction);
      march.in_organ = true;
    }
  }
}

March march_of(Ray ray, ivec2 pixel) {
  return March(ray.box_origin, ray.box_direction, ray.begin, -1.0, ray.begin, 0.0, false, vec2(0.0));
}
