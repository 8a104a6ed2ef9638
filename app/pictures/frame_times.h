#pragma once

#include <array>
#include <filesystem>
#include <vector>

namespace insonate {

/// What a window's frame spends its time on, in this order.
enum class FramePart { session, ultrasound, slices, volume, layout, window, present };
inline constexpr std::array<const char*, 7> kFrameParts{"session", "ultrasound", "slices", "volume",
                                                        "layout",  "window",     "present"};

/// Measures a window's frames, for `insonate-bench window`.
class FrameTimes {
public:
  /// @param parts  waits for the graphics card after each part, to learn how long it takes. Frames take longer then.
  explicit FrameTimes(bool parts) : parts_(parts) {}

  /// Begins a frame at `now_s` (steady_now_s()).
  void begin(double now_s);
  /// Ends a part of the frame: the time since the part before counts for it. Does nothing unless parts are measured.
  /// Needs the OpenGL context current.
  void end(FramePart part);
  /// How a frame ended.
  struct Outcome {
    bool new_picture = false;  ///< the ultrasound's pixels are new
    bool shown = false;        ///< the window's picture has changed and was shown
    long pixels_drawn = 0;     ///< of the window
    double quality = 1;        ///< of the ultrasound (QualityGovernor)
    long volumes = 0;          ///< pictures of the volume view that were drawn so far
    int volume_scale = 1;      ///< pixels of the screen per pixel of the volume view, along each side
  };
  void finish(double now_s, const Outcome& outcome);

  /// Writes the frames as CSV, one per row; times of day are steady_now_s(). Throws InputError if it cannot.
  void write(const std::filesystem::path& file) const;

private:
  struct Frame {
    double begin_s = 0, end_s = 0;
    std::array<double, kFrameParts.size()> part_s{};
    Outcome outcome;
  };
  bool parts_;
  double part_began_s_ = 0;
  std::vector<Frame> frames_;
};

}  // namespace insonate
