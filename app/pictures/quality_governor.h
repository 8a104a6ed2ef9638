#pragma once

namespace insonate {

/// Decides how many pixels the window's ultrasound is computed for. While the picture changes from frame to frame on a
/// machine that cannot keep up, it gets fewer pixels. Once it stands still it gets all of them, so that close
/// inspection and measurements do not depend on the speed of the machine. A moving picture that is recorded keeps the
/// pixels that it was drawn with.
class QualityGovernor {
public:
  static constexpr double kLeast = 0.6;
  /// Time without any computation after which the picture counts as still.
  static constexpr double kRest_s = 0.3;

  /// Returns the share of the screen's pixels along each side for the next frame, kLeast to 1.
  double quality() const { return moves_ ? of_motion_ : 1; }

  /// To be called once per frame.
  /// @param now_s     when the frame began, on any monotonic clock
  /// @param frame_s   how long it took
  /// @param computed  whether any stage of the ultrasound ran in it
  void see(double now_s, double frame_s, bool computed);

private:
  void see_motion(double frame_s);

  bool moves_ = false, computed_before_ = false;
  double computed_s_ = 0;  // of the last frame that computed anything
  double of_motion_ = 1;   // quality while the picture moves
  int frames_ = 0, slow_ = 0, quick_ = 0;
};

}  // namespace insonate
