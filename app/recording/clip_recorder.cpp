#include "app/recording/clip_recorder.h"

#include <vpx/vp8cx.h>
#include <vpx/vpx_encoder.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "app/recording/webm.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"

namespace insonate {
namespace {

/// Some tenths of a second: enough to bridge a busy moment.
constexpr std::size_t kMaxWaiting = 8;
/// Seeking in a clip goes to these.
constexpr unsigned kKeyEvery = 60;
/// Speckle is noise, which compresses badly: at this rate (kbit/s) its grain stays. The rate is a limit, not a target.
constexpr unsigned kBitRate = 8000;
/// VP8's scale of coarseness, 0 to 63.
constexpr unsigned kConstantQuality = 10;
/// Of VP8's real-time mode, 0 to 16.
constexpr int kSpeed = 8;

Image<Rgba8> fitted(const Image<Rgba8>& picture, int width, int height) {
  if (picture.width == width && picture.height == height) return picture;
  Image<Rgba8> out(width, height, {0, 0, 0, 255});
  const int right = (width - picture.width) / 2, down = (height - picture.height) / 2;
  for (int y = std::max(down, 0); y < std::min(height, down + picture.height); ++y)
    for (int x = std::max(right, 0); x < std::min(width, right + picture.width); ++x)
      out.at(x, y) = picture.at(x - right, y - down);
  return out;
}

}  // namespace

/// VP8 in a WebM file.
class ClipRecorder::Encoder {
public:
  Encoder(int width, int height) : file_(width, height), width_(width), height_(height) {
    vpx_codec_enc_cfg_t settings;
    vpx_codec_iface_t* const vp8 = vpx_codec_vp8_cx();
    check(vpx_codec_enc_config_default(vp8, &settings, 0));
    settings.g_w = unsigned(width);
    settings.g_h = unsigned(height);
    settings.g_timebase = {1, 1000};
    settings.rc_end_usage = VPX_CQ;
    settings.rc_target_bitrate = kBitRate;
    settings.kf_max_dist = kKeyEvery;
    check(vpx_codec_enc_init(&codec_, vp8, &settings, 0));
    vpx_codec_control(&codec_, VP8E_SET_CPUUSED, -kSpeed);
    vpx_codec_control(&codec_, VP8E_SET_CQ_LEVEL, kConstantQuality);
    if (!vpx_img_alloc(&picture_, VPX_IMG_FMT_I420, unsigned(width), unsigned(height), 16)) {
      vpx_codec_destroy(&codec_);
      throw std::bad_alloc();
    }
  }
  ~Encoder() {
    vpx_img_free(&picture_);
    vpx_codec_destroy(&codec_);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  void add(const Image<Rgba8>& image, std::int64_t time_ms) {
    time_ms = std::max(time_ms, last_ms_ + 1);
    convert(image);
    check(vpx_codec_encode(&codec_, &picture_, time_ms, 1, 0, VPX_DL_REALTIME));
    last_ms_ = time_ms;
    take_frames();
  }

  std::string finish() {
    check(vpx_codec_encode(&codec_, nullptr, 0, 0, 0, VPX_DL_REALTIME));
    take_frames();
    return file_.bytes();
  }

private:
  static void check(vpx_codec_err_t error) {
    if (error != VPX_CODEC_OK)
      throw InputError("clip", "", std::string("it cannot be encoded (") + vpx_codec_err_to_string(error) + ")",
                       "make it again, of a smaller window");
  }

  void take_frames() {
    vpx_codec_iter_t at = nullptr;
    while (const vpx_codec_cx_pkt_t* packet = vpx_codec_get_cx_data(&codec_, &at)) {
      if (packet->kind != VPX_CODEC_CX_FRAME_PKT) continue;
      const auto& frame = packet->data.frame;
      file_.add({static_cast<const char*>(frame.buf), frame.sz}, frame.pts, frame.flags & VPX_FRAME_IS_KEY);
    }
  }

  /// Fills in the codec's picture: ITU-R BT.601, 16 to 235, colour at half the resolution.
  void convert(const Image<Rgba8>& image) {
    for (int y = 0; y < height_; ++y) {
      std::uint8_t* const row = picture_.planes[VPX_PLANE_Y] + y * picture_.stride[VPX_PLANE_Y];
      for (int x = 0; x < width_; ++x) {
        const Rgba8& p = image.at(x, y);
        row[x] = std::uint8_t((66 * p[0] + 129 * p[1] + 25 * p[2] + 128 + 16 * 256) >> 8);
      }
    }
    for (int y = 0; y < (height_ + 1) / 2; ++y)
      for (int x = 0; x < (width_ + 1) / 2; ++x) {
        int r = 0, g = 0, b = 0;
        for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
          const Rgba8& p = image.at(std::min(2 * x + dx, width_ - 1), std::min(2 * y + dy, height_ - 1));
          r += p[0];
          g += p[1];
          b += p[2];
        }
        constexpr int kMiddle = 128 * 1024 + 512;
        picture_.planes[VPX_PLANE_U][y * picture_.stride[VPX_PLANE_U] + x] =
            std::uint8_t((-38 * r - 74 * g + 112 * b + kMiddle) >> 10);
        picture_.planes[VPX_PLANE_V][y * picture_.stride[VPX_PLANE_V] + x] =
            std::uint8_t((112 * r - 94 * g - 18 * b + kMiddle) >> 10);
      }
  }

  WebmFile file_;
  int width_, height_;
  vpx_codec_ctx_t codec_{};
  vpx_image_t picture_{};
  std::int64_t last_ms_ = -1;
};

ClipRecorder::~ClipRecorder() {
  const std::lock_guard lock(mutex_);
  ending_ = true;
  dropped_ = running_;  // a clip that was stopped is still written
  changed_.notify_all();
}

void ClipRecorder::start(const std::filesystem::path& stem) {
  if (running_) return;
  wait();
  running_ = true;
  any_ = ending_ = dropped_ = false;
  first_s_ = last_s_ = 0;
  waiting_.clear();
  thread_ = std::jthread([this, stem] { run(stem); });
}

void ClipRecorder::stop() {
  if (!std::exchange(running_, false)) return;
  const std::lock_guard lock(mutex_);
  ending_ = true;
  changed_.notify_all();
}

void ClipRecorder::stop(double time_s) {
  if (running_ && any_ && time_s > last_s_) enqueue(std::exchange(last_, {}), time_s);
  stop();
}

bool ClipRecorder::take(const Image<Rgba8>& picture, double time_s) {
  if (!running_) return false;
  if (!std::exchange(any_, true)) {
    first_s_ = time_s;
    last_ = picture;
  } else {
    last_ = fitted(picture, last_.width, last_.height);
  }
  const bool taken = enqueue(last_, time_s);
  if (duration_s() >= kLongest_s) stop();
  return taken;
}

bool ClipRecorder::enqueue(Image<Rgba8> picture, double time_s) {
  last_s_ = time_s;
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= kMaxWaiting) return false;
  waiting_.push_back({std::move(picture), time_s - first_s_});
  changed_.notify_all();
  return true;
}

void ClipRecorder::wait() {
  if (thread_.joinable() && !running_) thread_.join();
}

std::optional<std::filesystem::path> ClipRecorder::take_finished() {
  const std::lock_guard lock(mutex_);
  if (const std::exception_ptr problem = std::exchange(problem_, nullptr)) {
    running_ = false;
    std::rethrow_exception(problem);
  }
  return std::exchange(finished_, std::nullopt);
}

void ClipRecorder::run(const std::filesystem::path& stem) {
  std::unique_ptr<Encoder> encoder;
  std::unique_lock lock(mutex_);
  try {
    for (;;) {
      changed_.wait(lock, [this] { return !waiting_.empty() || ending_; });
      if (dropped_) return;
      if (waiting_.empty()) break;
      const Picture picture = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      if (!encoder) encoder = std::make_unique<Encoder>(picture.image.width, picture.image.height);
      encoder->add(picture.image, std::llround(1000 * picture.time_s));
      lock.lock();
    }
    lock.unlock();
    if (!encoder) throw InputError(stem.string(), "", "the clip has no picture", "scan while it is made");
    const std::filesystem::path file = free_path(stem, ".webm");
    write_file(file, encoder->finish());
    lock.lock();
    finished_ = file;
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    problem_ = std::current_exception();
  }
}

}  // namespace insonate
