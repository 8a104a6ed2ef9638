// What a person hands to the set-up: the patient's landmarks and the probe's drawing.
#include <set>

#include "devices/calibration/setup_input.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

std::string broken_by_landmarks(const std::filesystem::path& file) {
  const LandmarkList list = read_landmark_list(file);
  std::set<std::string> names;
  std::size_t held_out = 0;
  for (const LandmarkPair& landmark : list.landmarks) {
    if (!names.insert(landmark.name).second) return "two landmarks have one name";
    held_out += landmark.held_out ? 1 : 0;
  }
  return held_out > 0 && list.landmarks.size() >= held_out + kMinLandmarks && list.landmarks.size() <= 64
             ? ""
             : "too few or too many landmarks were taken";
}

std::string broken_by_drawing(const std::filesystem::path& file) {
  const ProbeDrawing drawing = read_probe_drawing(file);
  const auto face = face_from_drawing(drawing, {});
  if (!face) return "a drawing was taken that gives no face";
  return why_not_rigid(face->fit.sensor_from_face.matrix()) ? "the drawn face is not rigid" : "";
}

const Target landmarks_target("landmarks", [](std::string_view bytes) -> std::string {
  const std::filesystem::path file = file_with("given.toml", bytes);
  const std::string broken = broken_by([&] { return broken_by_landmarks(file); });
  return broken.empty() ? broken_by_drawing(file) : broken;
});

}  // namespace
}  // namespace insonate::fuzz
