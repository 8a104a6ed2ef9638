#include "tools/register/sweep_options.h"

#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/files/files.h"
#include "sim/files/png.h"
#include "sim/probe/probe.h"
#include "tools/cli/pose_file.h"
#include "tools/cli/program.h"

namespace insonate {
namespace {

constexpr std::size_t kLargestStart = 1u << 24;

}  // namespace

SweepInput SweepOptions::input() const {
  SweepInput input;
  if (!probe_file.empty()) {
    input.probe = read_probe(probe_file);
  } else if (!probe_name.empty()) {
    const Probe* probe = find_probe(probe_name);
    if (!probe)
      throw InputError("--probe", "", "there is no probe named '" + probe_name + "'",
                       suggest(probe_name, probe_names()));
    input.probe = *probe;
  } else if (depth_mm) {
    throw InputError("--depth", "", "the probe is found from the images, and its depth with it",
                     "leave it out, or name the probe too");
  }
  input.depth_mm = depth_mm;
  if (!image_matrix_file.empty()) input.probe_from_pixel = read_image_matrix(image_matrix_file);
  if (!face_pixel.empty()) input.face_pixel = glm::dvec2(face_pixel[0], face_pixel[1]);
  if (!clip.empty()) input.clip = {clip[0], clip[1], clip[2], clip[3]};
  if (!mask_file.empty()) {
    input.mask = read_png(mask_file);
    input.mask_file = mask_file;
    if (std::ranges::all_of(input.mask->pixels, [](std::uint8_t pixel) { return pixel == 0; }))
      throw InputError(mask_file, "", "the mask is black, so that nothing of the images is left",
                       "draw what to use in white");
  }
  return input;
}

StartTransform SweepOptions::start() const {
  if (!start_file.empty()) {
    // An affine result holds its rigid part too.
    const auto json = nlohmann::json::parse(read_file(start_file, kLargestStart), nullptr, false);
    const bool is_affine = json.is_object() && json.contains("ct_from_sweep_rigid");
    return {read_pose(start_file, is_affine ? "ct_from_sweep_rigid" : "ct_from_sweep").matrix(), std::nullopt};
  }
  if (!landmarks_file.empty()) return start_from_landmarks(landmarks_file);
  return {};
}

std::vector<CLI::Option*> declare_sweep_options(CLI::App& arguments, SweepOptions& options) {
  CLI::Option* named = arguments.add_option("--probe", options.probe_name, "Take the images to be of this probe")
                           ->type_name(one_of(probe_names()))
                           ->default_str("found from the fan in the images");
  arguments
      .add_option("--probe-file", options.probe_file,
                  "Read the probe from this file instead (TOML): kind, radius_mm, field_of_view_deg, width_mm and "
                  "depth_mm, as far as that kind has them")
      ->type_name("FILE")
      ->excludes(named);
  arguments.add_option("--depth", options.depth_mm, "Set the imaging depth of the named probe, mm")
      ->check(CLI::Range(10.0, 400.0))
      ->default_str("that of the probe");
  arguments
      .add_option("--image-to-probe", options.image_matrix_file,
                  "Read how the images lie in the probe's frame from this file: 16 numbers by rows, mm per pixel")
      ->type_name("FILE")
      ->default_str("as the images say");
  arguments.add_option("--face-pixel", options.face_pixel, "Set the pixel that shows the middle of the probe's face")
      ->type_name("X,Y")
      ->delimiter(',')
      ->expected(2)
      ->default_str("found, or with a named probe where the probe's frame has its origin");
  arguments.add_option("--clip", options.clip, "Take only this part of the images, pixels")
      ->type_name("X,Y,WIDTH,HEIGHT")
      ->delimiter(',')
      ->expected(4)
      ->default_str("found, or with a named probe all of them");
  arguments
      .add_option("--mask", options.mask_file,
                  "Leave out the pixels that are black in this picture of the images' size (PNG)")
      ->type_name("FILE");
  CLI::Option* start =
      arguments
          .add_option("--start", options.start_file,
                      "Read the start from this file: 16 numbers by rows, the map ct_from_sweep in mm (LPS), or a "
                      "registration.json")
          ->type_name("FILE")
          ->default_str("the recording's own frame");
  CLI::Option* landmarks =
      arguments
          .add_option("--landmarks", options.landmarks_file,
                      "Fit the start to landmarks in this file: per landmark x y z in the recording's frame and x y z "
                      "in the CT, mm (LPS)")
          ->type_name("FILE")
          ->excludes(start);
  return {start, landmarks};
}

}  // namespace insonate
