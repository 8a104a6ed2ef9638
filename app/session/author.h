#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/session/session.h"

namespace insonate {

/// Authoring: whoever knows how holds the probe, freezes the picture, says what it is called and what it must show,
/// and that becomes a reference view of a case folder. Knows no screen.
class Author {
public:
  /// Something in the frozen picture that the view may be asked to show.
  struct Part {
    std::string name;  ///< of the case's label or landmark
    bool landmark = false;
    bool wanted = false;
  };
  /// As many as there is room for: the largest structures of the picture, and landmarks.
  static constexpr std::size_t kMostStructures = 14, kMostLandmarks = 4;

  explicit Author(std::filesystem::path case_folder) : case_folder_(std::move(case_folder)) {}

  /// To be called after each Session::advance(). Another picture has other parts; those are wanted that were.
  void see(const Session& session);

  /// What the frozen picture shows; empty while it runs.
  const std::vector<Part>& parts() const { return parts_; }
  /// Wants what was not wanted, and the other way round; nothing for an index that is not there.
  void toggle(std::size_t part);

  /// As people read it; the view's name in the case is made of it.
  void title(const std::string& text) { title_ = text; }
  const std::string& title() const { return title_; }

  /// Whether there is all that a view needs: a frozen picture, a title, and something that it must show.
  bool ready() const;
  /// Writes the view into the case folder, and makes ready for the next. Throws what add_view() throws; nothing is
  /// lost then.
  /// @return  the view, which the session's own case does not have; empty when nothing was ready
  std::optional<ReferenceView> keep(const Session& session);
  /// What was kept last, as a sentence; empty before.
  const std::string& kept() const { return kept_; }

private:
  std::filesystem::path case_folder_;
  std::optional<Pose> picture_;
  double depth_mm_ = 0;
  std::string probe_;
  std::vector<Part> parts_;
  std::set<std::string> wanted_;  ///< names, also of what is not in this picture
  std::string title_, kept_;
};

/// The name that a title gives a view: "Right kidney, long axis" is "right_kidney_long_axis". Empty when there is no
/// letter in it to begin with.
std::string view_name_of(const std::string& title);

}  // namespace insonate
