#pragma once

namespace insonate {

/// Decides how many pixels the window's ultrasound is computed for: fewer while it changes from frame to frame on a
/// machine that cannot keep up, all of them once it stands still, so that what is looked at closely or measured in does
/// not hang on how fast the machine was. What is kept of a picture that moves has the pixels that it was drawn with.
class QualityGovernor {
public:
  static constexpr double kLeast = 0.6;
  /// How long nothing has to be computed until the picture stands still.
  static constexpr double kRest_s = 0.3;

  /// The share of the screen's pixels along each side for the next frame, kLeast to 1.
  double quality() const { return moves_ ? of_motion_ : 1; }

  /// To be told of each frame.
  /// @param now_s     when it began, on any clock that never goes back
  /// @param frame_s   how long it took
  /// @param computed  whether any stage of the ultrasound ran in it
  void see(double now_s, double frame_s, bool computed);

private:
  void see_motion(double frame_s);

  bool moves_ = false, computed_before_ = false;
  double computed_s_ = 0;  // the last frame that did
  double of_motion_ = 1;   // the quality while the picture moves
  int frames_ = 0, slow_ = 0, quick_ = 0;
};

}  // namespace insonate
