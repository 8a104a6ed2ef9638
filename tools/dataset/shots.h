#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/core/pose.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "sim/volume/case.h"
#include "tools/dataset/patients.h"
#include "tools/dataset/study.h"

namespace insonate {

/// All that an image of a dataset is computed from, besides its patient.
struct Shot {
  std::uint32_t index = 0;  ///< in the dataset, from 0
  std::string pose_source;  ///< "skin", "view hepatorenal", "log scan.igs.mha, sample 17"
  Probe probe;
  double depth_mm = 0;
  Settings settings;
  Pose patient_from_probe;
};

/// Draws the images of a study that show one patient.
class ShotMaker {
public:
  /// Keeps references to all three. Throws InputError for poses that this patient does not have: views that the case
  /// lacks, views of a probe that the study does not list, logs that cannot be read or hold no pose, and a patient for
  /// whom the study lists no poses.
  ShotMaker(const Study& study, const StudyPatient& patient, const Case& subject);

  /// Draws an image. The result depends on the study, the patient and the index alone. The probe touches the skin
  /// (SkinContact), and does not lie deep within the body: a pose that does not is drawn again. Throws InputError if
  /// kMaxAttempts draws find none.
  Shot at(std::uint32_t index) const;
  static constexpr std::uint32_t kMaxAttempts = 1000;

private:
  bool is_within_body(const Pose& patient_from_probe) const;

  /// A pose to start from.
  struct Start {
    std::string source;
    Pose pose;
    std::vector<std::size_t> probes;  ///< indices into Study::probes, at least one
  };
  /// [[poses]] as they apply to the patient.
  struct Way {
    const StudyPoses* poses;
    std::vector<Start> starts;        ///< empty for the skin
    std::vector<std::size_t> probes;  ///< for the skin
  };
  Way way_of(const StudyPoses& poses) const;
  void add_views(Way& way) const;
  void add_log(Way& way) const;
  std::vector<std::size_t> listed_probes(const StudyPoses& poses) const;

  const Study* study_;
  const StudyPatient* patient_;
  const Case* case_;
  std::vector<Way> ways_;
  std::vector<double> weights_;  ///< of ways_
  NumberRange height_mm_;        ///< of the CT's corners along patient z
};

}  // namespace insonate
