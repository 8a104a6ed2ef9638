#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/session/session.h"

namespace insonate {

/// Turns a frozen picture into a reference view of a case folder: an expert holds the probe, freezes the picture, gives
/// it a title and chooses what it must show. Does not depend on the screen.
class Author {
public:
  /// Something in the frozen picture that the view may require.
  struct Part {
    std::string name;  ///< of the case's label or landmark
    bool landmark = false;
    bool wanted = false;
  };
  /// Limits set by the room on the screen: the largest structures of the picture, and landmarks.
  static constexpr std::size_t kMaxStructures = 14, kMaxLandmarks = 4;

  explicit Author(std::filesystem::path case_folder) : case_folder_(std::move(case_folder)) {}

  /// To be called after each Session::advance(). A new picture has new parts; those that were wanted before stay
  /// wanted.
  void see(const Session& session);

  /// Returns what the frozen picture shows; empty while the picture runs.
  const std::vector<Part>& parts() const { return parts_; }
  /// Inverts whether a part is wanted. Does nothing if the index is out of range.
  void toggle(std::size_t part);

  /// Sets the title as people read it. The view's name in the case is derived from it.
  void title(const std::string& text) { title_ = text; }
  const std::string& title() const { return title_; }

  /// Returns whether the view is complete: a frozen picture, a title, and at least one part that it must show.
  bool ready() const;
  /// Writes the view into the case folder and prepares for the next view. Throws what add_view() throws; nothing is
  /// lost then.
  /// @return the view, which the session's own case does not contain; empty if ready() was false
  std::optional<ReferenceView> keep(const Session& session);
  /// Returns a sentence about the last view that was written; empty before the first.
  const std::string& kept() const { return kept_; }

private:
  std::filesystem::path case_folder_;
  std::optional<Pose> picture_;
  double depth_mm_ = 0;
  std::string probe_;
  std::vector<Part> parts_;
  std::set<std::string> wanted_;  ///< names, including those that this picture does not show
  std::string title_, kept_;
};

/// Returns the view name that is made from a title: "Right kidney, long axis" becomes "right_kidney_long_axis". Empty
/// if the title contains no letter to begin with.
std::string view_name_of(const std::string& title);

}  // namespace insonate
