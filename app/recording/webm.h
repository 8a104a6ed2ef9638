#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// Puts the frames of one VP8 video into a WebM file, which browsers and media players open. Debian's libwebm has no
/// headers for writing, and this is the part of Matroska that a silent clip needs: RFC 8794 (EBML), RFC 9559.
class WebmFile {
public:
  /// @param width, height  of the video, pixels, 1 to 16383
  WebmFile(int width, int height) : width_(width), height_(height) {}

  /// Adds an encoded frame.
  /// @param time_ms  since the first frame; not before the frame before it
  /// @param is_key   whether it can be decoded by itself; the first one has to
  void add(std::string_view frame, std::int64_t time_ms, bool is_key);

  /// Returns the bytes of the whole file. The last frame is shown as long as the frames before it on average.
  std::string bytes() const;

private:
  /// Frames from one that can be decoded by itself to the next.
  struct Cluster {
    std::int64_t time_ms;
    std::string blocks;
  };

  int width_, height_;
  std::vector<Cluster> clusters_;
  std::int64_t last_ms_ = 0, frames_ = 0;
};

}  // namespace insonate
