#pragma once

#include <vector>

namespace insonate {

/// Decides what the window leaves out while the picture moves, on a machine that cannot draw everything 30 times a
/// second. First the views beside the ultrasound take turns, one per frame and then one per two frames. Then the
/// ultrasound gets fewer pixels, samples along its lines, and lines. At last the other views have fewer turns, down
/// to one per five frames. Once the picture stands still everything is drawn in full, so that close inspection and
/// measurements do not depend on the speed of the machine. A moving picture that is recorded keeps the pixels that it
/// was drawn with.
class QualityGovernor {
public:
  static constexpr double kMin = 0.6;
  /// The time that a frame of a moving picture may take.
  static constexpr double kFrame_s = 1.0 / 30;
  /// Decides this often during motion, so that a few decisions fit in half a second.
  static constexpr double kPeriod_s = 0.15;
  /// Time without any computation after which the picture counts as still.
  static constexpr double kRest_s = 0.15;

  /// Begins with everything in full, or for a software renderer with what its first motion would come to: on two cores
  /// the decisions take longer than half a second, because the shaders of each quality are compiled meanwhile.
  explicit QualityGovernor(bool for_software_renderer = false);

  /// Returns whether the ultrasound moves.
  bool moves() const { return moves_; }
  /// Returns the share of the screen's pixels along each side for the next frame, kMin to 1.
  double quality() const { return moves_ ? of_motion_ : 1; }
  /// Returns per how many frames one of the views beside the ultrasound is drawn: 0 (all are drawn in each frame), or 1
  /// to 5.
  int frames_per_turn() const { return moves_ ? turns_of_motion_ : 0; }

  /// To be called once per frame.
  /// @param now_s     when the frame began, on any monotonic clock
  /// @param frame_s   how long it took
  /// @param computed  whether any stage of the ultrasound ran in it
  void see(double now_s, double frame_s, bool computed);

private:
  void see_motion(double frame_s);
  void decide(double frame_s);
  void decide_turns();

  bool waits_for_screen_ = true;  // between frames
  bool moves_ = false, computed_before_ = false;
  double computed_s_ = 0;  // of the last frame that computed anything
  double of_motion_ = 1;   // quality while the picture moves
  int turns_of_motion_ = 0;
  std::vector<double> frames_s_;  // since the last decision
  double at_floor_s_ = 0;         // of frames with the fewest pixels since the last decision on turns
  int at_floor_ = 0;
};

}  // namespace insonate
