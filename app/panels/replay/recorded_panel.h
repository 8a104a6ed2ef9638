#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"
#include "app/replay/replay.h"
#include "devices/sequence/recorded_images.h"
#include "sim/gl/objects.h"

namespace insonate::ui {

/// Shows the recording's image of a replay's moment beside the simulated picture. If the recording gives its images a
/// pose (ImageToProbe), each is drawn at its place in the probe's plane and at the picture's scale, so that the same
/// tissue lies at the same place in both panels. Otherwise the image is drawn as large as fits, with a note. Reads one
/// image at a time. Needs the OpenGL context current.
class RecordedPanel {
public:
  RecordedPanel();
  ~RecordedPanel();
  RecordedPanel(const RecordedPanel&) = delete;
  RecordedPanel& operator=(const RecordedPanel&) = delete;

  /// @param panel  must have the same size as that of the simulated picture
  void draw(const Theme& theme, const Rect& panel, const Replay& replay, const Pictures& pictures);

  /// Returns a number that changes whenever the pixels of that texture do, if it shows the image; 0 if not.
  long version_of(GLuint texture) const { return texture_.name() == texture ? shown_ : 0; }

private:
  void show(const Replay& replay);

  const Replay* replay_ = nullptr;  ///< the replay that `reader_` belongs to
  std::unique_ptr<ImageReader> reader_;
  gl::Texture texture_;
  long shown_ = 0;                     ///< how many images `texture_` has shown
  std::optional<std::size_t> sample_;  ///< the sample that `texture_` or `problem_` belongs to
  std::string problem_;
};

/// Returns the corners of an image in the probe's frame, mm, in the order of the pixels (0, 0), (width, 0), (width,
/// height), (0, height). Empty if the recording gives its images no pose.
std::optional<std::array<glm::dvec3, 4>> image_corners(const RecordedImages& images, std::size_t sample);

}  // namespace insonate::ui
