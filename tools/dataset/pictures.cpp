#include "tools/dataset/pictures.h"

#include <utility>

#include "sim/imaging/upload.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/volume/open_case.h"

namespace insonate {

void PictureMaker::set_patient(const std::string& source, const Case& subject, const TissueTable& tissues,
                               bool structure) {
  const AcousticVolume volume =
      make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), tissues, structure);
  gl::upload_ct(source, volume.grid, [&] { simulator_.set_volume(volume, tissues); });
}

void PictureMaker::draw(Shot&& shot, const Take& take) {
  if (readback_.full()) take_next(take);
  simulator_.set_probe(shot.probe, shot.depth_mm);
  Settings settings = shot.settings;
  settings.exact_filter = settings.exact_filter || has_coarse_filter_;
  simulator_.set_settings(settings);
  // Another pose first, so that even a shot from the same pose is traversed anew: what skipping left out under the
  // settings before could show by a grey level.
  Pose elsewhere = shot.patient_from_probe;
  elsewhere.translation.x += 1;
  simulator_.set_pose(elsewhere);
  simulator_.set_pose(shot.patient_from_probe);
  readback_.begin(simulator_.image());
  under_way_.push_back(std::move(shot));
}

void PictureMaker::finish(const Take& take) {
  while (!under_way_.empty()) take_next(take);
}

void PictureMaker::take_next(const Take& take) {
  Image<std::uint8_t> grey = readback_.take(true).value();
  Shot shot = std::move(under_way_.front());
  under_way_.pop_front();
  take(std::move(shot), std::move(grey));
}

}  // namespace insonate
