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
  std::uint8_t value = 0;  ///< as in the label volume; 0 means "no structure" and is never listed
  std::string name;        ///< unique in the case, lower case with underscores: "right_kidney_cortex"
  std::string tissue;      ///< a name of the tissue table's [tissue.*]: "kidney_cortex"
};

/// An anatomical point that an examiner would point at.
struct Landmark {
  std::string name;          ///< unique in the case: "hepatorenal_recess"
  glm::dvec3 position{0.0};  ///< patient (LPS), mm
};

/// The pose in which an expert holds the probe to show a structure.
struct ReferenceView {
  std::string name;                    ///< unique in the case: "hepatorenal"
  std::string title;                   ///< the text on the screen: "Right upper quadrant, hepatorenal recess"
  std::string probe;                   ///< a name known to find_probe(): "curvilinear"
  double depth_mm = 160;               ///< 20 to 300
  std::vector<std::string> landmarks;  ///< landmarks that must be in the picture; names of landmarks of the case
  std::vector<std::string> targets;    ///< labels whose area in the picture counts; names of labels of the case
  Pose patient_from_probe;
};

/// A patient or a phantom, ready to be scanned.
struct Case {
  std::string name;             ///< the name on the screen: "Abdomen phantom"
  Volume<std::int16_t> ct;      ///< Hounsfield units, -1024 to 32767
  Volume<std::uint8_t> labels;  ///< on the CT's grid; empty if the case has none
  std::vector<Label> label_table;
  std::vector<Landmark> landmarks;
  std::vector<ReferenceView> views;

  /// Each returns the entry of that name, or null if there is none.
  const Label* find_label(std::string_view name) const;
  const Landmark* find_landmark(std::string_view name) const;
  const ReferenceView* find_view(std::string_view name) const;
};

/// Reads a case folder. This is the format of its case.toml; names that the file refers to are lower case with
/// underscores, and files lie in the folder itself:
///
///     format = 1                           # of this file
///     name = "Abdomen phantom"
///     ct = "ct.nrrd"                       # a file that read_case_ct() reads
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
/// Throws InputError with line and column for a key or value that is missing, unknown or out of range, for a name that
/// is used twice or refers to nothing, and for a pose that is not rigid. Also throws for labels on another grid than
/// the CT's (a corner is off by more than 0.1 voxels). A label that no voxel carries is a finding that this patient
/// lacks; it is accepted.
Case read_case(const std::filesystem::path& folder);

/// Returns the name of a case without reading its volumes. Throws InputError as read_case() does for case.toml.
std::string read_case_name(const std::filesystem::path& folder);

/// Throws the InputError that write_case() would throw for the folder alone: something that is not a case is in the
/// way, or the place cannot be written to. Call it before building a case takes long.
void check_case_can_be_written(const std::filesystem::path& folder);

/// Writes a case folder atomically: it appears under its name only when every file in it is written, and replaces an
/// older case as a whole. The volumes are raw NRRD, because the user waits while a cached phantom is read. Throws
/// InputError if the folder cannot be written or holds something that is not a case, and for a case that read_case()
/// would refuse.
void write_case(const std::filesystem::path& folder, const Case& subject);

/// Appends a view to a case folder's case.toml. The file is replaced atomically and keeps its whole content, comments
/// included. Throws InputError for a view that read_case() would refuse, and for a file that lists its views in one
/// `view = [...]`.
void append_view(const std::filesystem::path& folder, const ReferenceView& view);

}  // namespace insonate
