#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/grid.h"
#include "sim/core/pose.h"

namespace insonate {

/// A structure in a case's label volume.
struct Label {
  std::uint8_t value = 0;  ///< as in the label volume; 0 is "nothing in particular" and never listed
  std::string name;        ///< unique in the case, lower case with underscores: "right_kidney_cortex"
  std::string tissue;      ///< a name of the tissue table's [tissue.*]: "kidney_cortex"
};

/// A point an examiner would point at.
struct Landmark {
  std::string name;          ///< unique in the case: "hepatorenal_recess"
  glm::dvec3 position{0.0};  ///< patient (LPS), mm
};

/// How an expert would hold the probe to show something.
struct ReferenceView {
  std::string name;                    ///< unique in the case: "hepatorenal"
  std::string title;                   ///< as a sentence on the screen: "Right upper quadrant, hepatorenal recess"
  std::string probe;                   ///< a name known to find_probe(): "curvilinear"
  double depth_mm = 160;               ///< 20 to 300
  std::vector<std::string> landmarks;  ///< what must be in the picture; names of the case's landmarks
  std::vector<std::string> targets;    ///< whose area in the picture counts; names of the case's labels
  Pose patient_from_probe;
};

/// A patient, or a phantom, ready to be scanned.
struct Case {
  std::string name;             ///< shown to people: "Abdomen phantom"
  Volume<std::int16_t> ct;      ///< Hounsfield units, -1024 to 32767
  Volume<std::uint8_t> labels;  ///< on the CT's grid; empty when the case has none
  std::vector<Label> label_table;
  std::vector<Landmark> landmarks;
  std::vector<ReferenceView> views;

  const Label* find_label(std::string_view name) const;
  const Landmark* find_landmark(std::string_view name) const;
  const ReferenceView* find_view(std::string_view name) const;
};

/// Reads a case folder. Its case.toml (names below are lower case with underscores, files lie in the folder itself):
///
///     format = 1                           # of this file
///     name = "Abdomen phantom"
///     ct = "ct.nrrd"                       # whatever read_case_ct() reads
///     labels = "labels.nrrd"               # optional; on the CT's grid
///
///     [[label]]                            # as Label; each value in the label volume has one
///     value = 7                            # 1 to 255
///     name = "liver"
///     tissue = "liver"
///
///     [[landmark]]                         # as Landmark
///     name = "hepatorenal_recess"
///     position = [-62.5, 14, 120]          # patient (LPS), mm
///
///     [[view]]                             # as ReferenceView
///     name = "hepatorenal"
///     title = "Right upper quadrant, hepatorenal recess"
///     probe = "curvilinear"
///     depth_mm = 160                       # 20 to 300
///     landmarks = ["hepatorenal_recess"]   # optional; names from above
///     targets = ["liver"]                  # optional; labels from above
///     patient_from_probe = [ ... ]         # 16 numbers, row-major, rigid
///
/// Throws InputError with line and column for what is missing, unknown, out of range, named twice or named without
/// being there, for a pose that is not rigid, and for labels on another grid than the CT's (0.1 voxels off at a
/// corner). A label that no voxel carries is a finding this patient lacks, and stays.
Case read_case(const std::filesystem::path& folder);

/// Throws the InputError that write_case() would throw for the folder alone: something that is no case is in the way,
/// or the place is not one to write to. For those who make a case at length before they write it.
void check_case_can_be_written(const std::filesystem::path& folder);

/// Writes a case folder whole or not at all: it appears under its name only when every file in it is written, and takes
/// the place of an older case as a whole. The volumes are raw NRRD: the reading of a cached phantom is what its user
/// waits for. Throws InputError when the folder cannot be written or holds something that is no case, and for a case
/// that read_case() would refuse.
void write_case(const std::filesystem::path& folder, const Case& subject);

/// Writes a view to the end of a case folder's case.toml, which is replaced as a whole and keeps all that is in it,
/// remarks too. Throws InputError for a view that read_case() would refuse, and for a file that lists its views in
/// one `view = [...]`.
void append_view(const std::filesystem::path& folder, const ReferenceView& view);

}  // namespace insonate
