#pragma once

#include <map>
#include <optional>
#include <vector>

#include "app/pictures/pictures.h"
#include "app/session/picture_tools.h"
#include "app/session/session.h"
#include "scenarios/report/report.h"
#include "sim/core/image.h"

namespace insonate {

/// Keeps, for each step of an attempt, the ultrasound picture of the moment at which its view was held best. Of a step
/// that asks to hold a view it also keeps the last pose, for the report of a view that was not held long enough. Of a
/// step that measures, points or names it keeps every frozen picture in which something is placed, with that.
class BestFrames {
public:
  /// Takes the session's state, before each of its advances.
  void see(const Session& session);
  /// Whether the view is held for longer than in the frame that is kept, by a tenth of what the step asks for, or
  /// something else is placed in a frozen picture, this one or an earlier one of the step: draw, then keep().
  /// @param tools  must have seen the session's current state
  bool due(const Session& session, const PictureTools& tools) const;
  /// Keeps the picture that was drawn last, marker on the left.
  void keep(const Session& session, const PictureTools& tools, const Pictures& pictures);
  /// Forgets frames of attempts before the session's.
  void forget_older(const Session& session);

  /// Returns the last step's newest; nullptr when no view was held.
  const Image<Rgba8>* last() const { return frames_.empty() ? nullptr : &frames_.rbegin()->second.back().frame; }
  /// Returns for the report each step's frames, one below the other, and what the step's view should look like. Of a
  /// view that was not held long enough the last picture is shown, to which the values belong; it is drawn now.
  std::vector<ReportPicture> report_pictures(const Session& session, Pictures& pictures) const;

private:
  struct Kept {
    Image<Rgba8> undrawn, frame;  ///< without and with what is placed in it
    ImageGeometry geometry;
    std::optional<Pose> picture;  ///< if it was frozen
    std::vector<Action> placed;   ///< in it

    void show(std::vector<Action> in_it);
  };
  static Image<Rgba8> stacked(const std::vector<Kept>& kept);
  const std::vector<Kept>* kept_of(const Session& session) const;

  struct Seen {
    Pose pose;
    Machine machine;
  };

  std::map<std::size_t, std::vector<Kept>> frames_;  ///< by step, never empty
  std::map<std::size_t, Seen> last_seen_;            ///< by step, of those that ask to hold a view
  int attempt_ = 0;                                  ///< whose frames these are; 0 for none
  std::size_t step_ = 0;                             ///< of the newest
  double share_ = 0;                                 ///< of the hold, when it was kept
};

}  // namespace insonate
