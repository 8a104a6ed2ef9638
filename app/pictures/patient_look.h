#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/core/grid.h"
#include "sim/view/body/organ_colours.h"
#include "sim/view/body/transfer_function.h"
#include "sim/volume/case.h"

namespace insonate {

/// A labelled structure whose surface can be shown within the CT.
struct StructureChoice {
  std::uint8_t label = 0;
  std::string title;  ///< as a person reads it: "right kidney cortex"
  glm::vec3 colour{1.0f};
  bool shown = false;
};

/// How the patient looks in the 3D view: with surfaces (view::kSurfaces), or as the CT through a transfer function,
/// which a person chooses and edits. The class stores the look per patient, and shows the patient so again.
class PatientLook {
public:
  /// Takes the bundled functions. Throws InputError if one cannot be read.
  PatientLook();

  /// Takes a person's own functions too, the files *.toml of a folder, and stores there how patients look. Returns a
  /// sentence for each file that cannot be used.
  std::vector<std::string> use_folder(const std::filesystem::path& folder);

  /// Returns the functions to choose from.
  const std::vector<view::TransferFunction>& offered() const { return offered_; }
  /// Returns the index of the chosen function; none for surfaces.
  const std::optional<std::size_t>& chosen() const { return chosen_; }
  /// Chooses a function as it is offered, without edits; none for surfaces.
  void choose(const std::optional<std::size_t>& index);
  /// Takes a function from elsewhere, such as a file that was opened. It replaces an offered one of its name.
  void take(const view::TransferFunction& function);

  /// Returns what is shown: the chosen function with its edits; none for surfaces.
  const std::optional<view::TransferFunction>& shown() const { return shown_; }
  /// Returns whether the shown function differs from the chosen one.
  bool is_edited() const { return shown_ && *shown_ != offered_[*chosen_]; }

  // Edits of the shown function; there must be one.

  /// Moves a point; it stays between its neighbours.
  void move_point(std::size_t index, double hu, double opacity);
  void colour_point(std::size_t index, const glm::dvec3& colour);
  /// Adds a point with the colour that the function has there, and returns its index; none if there are as many as a
  /// file may have.
  std::optional<std::size_t> add_point(double hu, double opacity);
  /// Removes a point, unless only two are left.
  void remove_point(std::size_t index);
  /// Move all points: by HU, and about their middle. Both are absolute, from the points as they were last edited.
  void shift(double hu);
  void scale(double factor);
  double shift_hu() const { return shift_hu_; }
  double scale_factor() const { return scale_; }

  /// Returns whether what is shown hides a plane within the body, so that the body has to be cut there: all but a
  /// function that leaves soft tissue clear, without structures.
  bool hides_plane() const;

  /// Writes the shown function to the person's folder and offers it, with "(edited)" behind the name of a bundled one.
  /// A function that came from a file there replaces it. Returns the file. Throws InputError if it cannot be written,
  /// std::logic_error without a folder.
  std::filesystem::path save();

  /// Shows a patient as they were left the last time; with surfaces if that is unknown or not readable.
  void begin(const std::string& patient, const Volume<std::int16_t>& ct);
  /// Offers a patient's structures: those labels that have a colour, none of them shown.
  void offer(const std::vector<Label>& labels, const view::OrganColours& colours);
  const std::vector<StructureChoice>& structures() const { return structures_; }
  /// Shows a structure's surface within the CT, or leaves it out. The surfaces stay when another look is chosen.
  void show_structure(std::size_t index, bool shown) { structures_[index].shown = shown; }
  /// Returns the labels of the structures that are shown.
  std::vector<std::uint8_t> shown_structures() const;

  /// Stores how the patient looks, if that has changed since begin(). Throws InputError if it cannot be written.
  void keep();

  /// Returns how often values occur in the CT: per bin from kFirstTransfer_hu on, the logarithm of its voxels, 0 to 1.
  const std::vector<float>& histogram() const { return histogram_; }
  static constexpr int kBin_hu = 8;

private:
  void edited();
  std::filesystem::path file_of_patient() const;

  std::vector<view::TransferFunction> offered_;
  std::size_t bundled_;  ///< the first of offered_
  std::filesystem::path folder_;
  std::map<std::string, std::filesystem::path> own_files_;  ///< by the function's name
  std::optional<std::size_t> chosen_;
  std::optional<view::TransferFunction> base_, shown_;  ///< before and after shift and scale
  double shift_hu_ = 0, scale_ = 1;
  std::vector<StructureChoice> structures_;
  std::string patient_;
  std::optional<view::TransferFunction> kept_;
  std::vector<float> histogram_;
};

}  // namespace insonate
