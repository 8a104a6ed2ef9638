#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <unordered_map>
#include <utility>

#include "devices/sequence/metaimage.h"
#include "devices/sequence/nrrd.h"
#include "devices/sequence/sequence.h"
#include "devices/sequence/sequence_text.h"
#include "sim/core/input_error.h"
#include "sim/image_headers/metaimage_header.h"
#include "sim/image_headers/nrrd_header.h"

namespace insonate {
namespace {

constexpr std::string_view kFramePrefix = "Seq_Frame";
constexpr std::string_view kTransform = "Transform";
constexpr std::string_view kTransformStatus = "TransformStatus";
constexpr std::string_view kOrientation = "UltrasoundImageOrientation",
                           kNrrdOrientation = "ultrasound image orientation";
// A tracked scan has a few transforms. The limit keeps the search within a frame short for any file.
constexpr std::size_t kMaxTransforms = 256;
// Length of the shortest line of a frame, "Seq_Frame0_Timestamp=0\n": a file cannot hold more frames than such lines.
constexpr std::size_t kMinFrameBytes = 23;

constexpr const char* kGiveSequence = "give a sequence file (.igs.mha, .seq.mha or .seq.nrrd)";
constexpr const char* kScanAgain = "record the scan again";
constexpr const char* kRecordWithTracker = "record it with a tracker, so that its frames have ProbeToTrackerTransform";

std::optional<glm::dmat4> to_matrix(std::string_view value) {
  const std::vector<std::string_view> numbers = words(value);
  if (numbers.size() != 16) return std::nullopt;
  glm::dmat4 rows;
  for (std::size_t i = 0; i < 16; ++i) {
    const auto number = to_number<double>(numbers[i]);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    glm::value_ptr(rows)[i] = *number;
  }
  return glm::transpose(rows);
}

/// Returns the buttons that a status word such as SWITCH2_IS_ON reports.
std::uint32_t buttons_of(std::string_view status) {
  const std::size_t digit = status.find_first_of("123");
  return digit == std::string_view::npos ? 0 : 1u << (status[digit] - '1');
}

class Parser {
public:
  Parser(const CutBytes& bytes, const std::string& file) : bytes_(bytes), is_nrrd_(is_nrrd(bytes.front)) {
    sequence_.file = file;
  }

  Sequence parse() {
    const auto keep_layout = [this](std::string_view name, std::string_view value, std::size_t line) {
      if (is_nrrd_ ? is_nrrd_layout_field(name) : is_layout_field(name)) keep_once(name, value, line);
    };
    const auto keep_key = [this](std::string_view name, std::string_view value, std::size_t line) {
      if (same_ignoring_case(name, kOrientation) || same_ignoring_case(name, kNrrdOrientation))
        sequence_.image_orientation = value;
      else if (name.starts_with(kFramePrefix))
        keep_frame_field(name, value, line);
      else
        keep_constant(name, value, line);
    };
    // PLUS writes the transforms in a NRRD header as fields, other writers as keys.
    const auto keep_field = [&](std::string_view name, std::string_view value, std::size_t line) {
      if (is_nrrd_ ? is_nrrd_data_file(name) : name == "ElementDataFile" && value != "LOCAL")
        fail("line " + std::to_string(line),
             "the header places the image data in " + quoted(value) + " instead of in this file",
             std::string("save the sequence as one ") + (is_nrrd_ ? ".seq.nrrd" : ".igs.mha or .seq.mha") + " file");
      keep_layout(name, value, line);
      keep_key(name, value, line);
    };
    sequence_.image_offset = is_nrrd_
                                 ? read_nrrd_header(bytes_.front, sequence_.file, kGiveSequence, keep_field, keep_key)
                                 : read_metaimage_header(bytes_.front, sequence_.file, kGiveSequence, keep_field);
    const CutBytes data = bytes_.from(sequence_.image_offset);
    const SequenceLayout layout =
        is_nrrd_ ? nrrd_layout(header_, data, sequence_.file) : metaimage_layout(header_, data.size, sequence_.file);
    sequence_.has_images = layout.has_images;
    sequence_.image_bytes = std::size_t(layout.image_bytes);
    sequence_.image_form = layout.form;
    make_frames(layout.frames);
    read_statuses();
    read_values();
    check_complete();
    if (sequence_.has_times) {
      sort_by_time();
      check_times();
    }
    return std::move(sequence_);
  }

private:
  struct FrameField {
    std::size_t frame;
    std::string_view name;
    std::string_view value;
    std::size_t line;
  };
  /// Which fields of a frame have been read already.
  struct Seen {
    bool time = false;
    bool buttons = false;
    bool distortion = false;
    bool rejected = false;
    bool actions = false;
    std::vector<int> statuses;  ///< transforms, by index of their name
    std::vector<int> matrices;
  };

  [[noreturn]] void fail(const std::string& place, const std::string& problem, const std::string& remedy) const {
    throw InputError(sequence_.file, place, problem, remedy);
  }
  [[noreturn]] void fail(std::size_t frame, const std::string& problem) const {
    fail("frame " + std::to_string(frame), problem, kScanAgain);
  }
  [[noreturn]] void fail_twice(const FrameField& field) const {
    fail(field.frame, quoted(field.name) + " is given a second time, in line " + std::to_string(field.line));
  }

  void keep_once(std::string_view name, std::string_view value, std::size_t line) {
    if (!header_.emplace(name, value).second)
      fail("line " + std::to_string(line), std::string(name) + " is given a second time", kExportAgain);
  }

  void keep_constant(std::string_view name, std::string_view value, std::size_t line) {
    if (name.size() <= kTransform.size() || !name.ends_with(kTransform)) return;
    keep_once(name, value, line);
    const auto matrix = to_matrix(value);
    if (!matrix)
      fail("line " + std::to_string(line), quoted(name) + " is not 16 finite numbers", "correct it in the header");
    sequence_.constants.emplace(name.substr(0, name.size() - kTransform.size()), *matrix);
  }

  void keep_frame_field(std::string_view name, std::string_view value, std::size_t line) {
    // The index ends at the first underscore after the prefix, which contains one itself.
    const std::size_t underscore = std::min(name.find('_', kFramePrefix.size()), name.size());
    const auto frame = to_number<std::uint32_t>(name.substr(kFramePrefix.size(), underscore - kFramePrefix.size()));
    if (!frame || underscore + 1 >= name.size())
      fail("line " + std::to_string(line), quoted(name) + " names no frame and field, as in 'Seq_Frame0000_Timestamp'",
           kExportAgain);
    highest_frame_ = std::max<std::size_t>(highest_frame_.value_or(0), *frame);
    name.remove_prefix(underscore + 1);
    // Of a frame's many possible fields only these are stored; the others concern only the writer.
    if (name == "Timestamp" || name == "Buttons" || name == "Distortion" || name == "Rejected" || name == "Actions" ||
        name.ends_with(kTransform) || name.ends_with(kTransformStatus))
      fields_.push_back({*frame, name, value, line});
  }

  void make_frames(std::uint64_t frames) {
    if (fields_.empty() && highest_frame_)
      fail("header", "its frames have no transforms, so it does not tell where the probe was", kRecordWithTracker);
    if (fields_.empty())
      fail("header", "no frame is described (there are no 'Seq_Frame0000_...' fields): it is a plain image",
           "give a tracked sequence (.igs.mha, .seq.mha or .seq.nrrd)");
    if (frames > bytes_.front.size() / kMinFrameBytes || *highest_frame_ >= frames)
      fail("header",
           "DimSize says " + std::to_string(frames) + " frames, but the last one described is frame " +
               std::to_string(*highest_frame_),
           kScanAgain);
    sequence_.frames.resize(std::size_t(frames));
    for (std::size_t f = 0; f < sequence_.frames.size(); ++f) sequence_.frames[f].number = f;
    seen_.resize(std::size_t(frames));
  }

  SequenceTransform& transform(std::size_t frame, std::string_view name) {
    const auto [found, added] = name_indices_.emplace(name, int(sequence_.transform_names.size()));
    if (added) {
      if (sequence_.transform_names.size() == kMaxTransforms)
        fail("header", "the frames have more than " + std::to_string(kMaxTransforms) + " different transforms",
             "record only those of the probe");
      sequence_.transform_names.emplace_back(name);
    }
    for (SequenceTransform& known : sequence_.frames[frame].transforms)
      if (known.name == found->second) return known;
    sequence_.frames[frame].transforms.push_back({found->second, PoseStatus::unknown, glm::dmat4(0.0)});
    return sequence_.frames[frame].transforms.back();
  }

  static bool add_new(std::vector<int>& to, int name) {
    if (std::find(to.begin(), to.end(), name) != to.end()) return false;
    to.push_back(name);
    return true;
  }

  /// Runs before the values are read, because a status decides whether its matrix must be valid, and either may come
  /// first.
  void read_statuses() {
    for (const FrameField& field : fields_) {
      if (!field.name.ends_with(kTransformStatus)) continue;
      SequenceTransform& stated =
          transform(field.frame, field.name.substr(0, field.name.size() - kTransformStatus.size()));
      if (!add_new(seen_[field.frame].statuses, stated.name)) fail_twice(field);
      stated.status = status_from_igsio(field.value);
      if (stated.status == PoseStatus::switched) sequence_.frames[field.frame].buttons |= buttons_of(field.value);
    }
  }

  void read_values() {
    for (const FrameField& field : fields_) {
      if (field.name == "Timestamp")
        read_time(field);
      else if (field.name == "Buttons")
        sequence_.frames[field.frame].buttons = read_whole(field, seen_[field.frame].buttons);
      else if (field.name == "Distortion")
        sequence_.frames[field.frame].distortion = read_whole(field, seen_[field.frame].distortion);
      else if (field.name == "Rejected")
        read_rejected(field);
      else if (field.name == "Actions")
        read_actions(field);
      else if (field.name.ends_with(kTransform))
        read_matrix(field);
    }
  }

  void read_time(const FrameField& field) {
    if (std::exchange(seen_[field.frame].time, true)) fail_twice(field);
    const auto time = to_number<double>(field.value);
    if (!time || !std::isfinite(*time))
      fail(field.frame, "its Timestamp is " + quoted(field.value) + " instead of a finite number");
    sequence_.frames[field.frame].time_s = *time;
  }

  std::uint32_t read_whole(const FrameField& field, bool& seen) const {
    if (std::exchange(seen, true)) fail_twice(field);
    const auto number = to_number<std::uint32_t>(field.value);
    if (!number)
      fail(field.frame, std::string(field.name) + " is " + quoted(field.value) + " instead of a whole number");
    return *number;
  }

  void read_rejected(const FrameField& field) {
    if (std::exchange(seen_[field.frame].rejected, true)) fail_twice(field);
    for (const Rejection why : {Rejection::jump, Rejection::mirror, Rejection::distortion})
      if (field.value == to_string(why)) sequence_.frames[field.frame].rejected = why;
  }

  void read_actions(const FrameField& field) {
    if (std::exchange(seen_[field.frame].actions, true)) fail_twice(field);
    sequence_.frames[field.frame].actions = field.value;
  }

  void read_matrix(const FrameField& field) {
    SequenceTransform& given = transform(field.frame, field.name.substr(0, field.name.size() - kTransform.size()));
    if (!add_new(seen_[field.frame].matrices, given.name)) fail_twice(field);
    if (given.status != PoseStatus::ok) return;
    const auto matrix = to_matrix(field.value);
    if (!matrix) fail(field.frame, quoted(field.name) + " is not 16 finite numbers");
    given.matrix = *matrix;
  }

  void check_complete() {
    sequence_.has_times = std::any_of(seen_.begin(), seen_.end(), [](const Seen& seen) { return seen.time; });
    for (std::size_t f = 0; f < seen_.size(); ++f) {
      if (sequence_.has_times && !seen_[f].time) fail(f, "it has no Timestamp");
      const std::vector<int>& matrices = seen_[f].matrices;
      for (const SequenceTransform& given : sequence_.frames[f].transforms)
        if (given.status == PoseStatus::ok && std::find(matrices.begin(), matrices.end(), given.name) == matrices.end())
          fail(f, sequence_.transform_names[std::size_t(given.name)] + " has the status OK, but no matrix");
    }
  }

  void sort_by_time() {
    double latest_s = sequence_.frames.front().time_s;
    for (const SequenceFrame& frame : sequence_.frames) {
      const double behind_s = latest_s - frame.time_s;
      if (behind_s > kLargestDisorder_s) fail_time(frame, "lies before", latest_s);
      if (behind_s > 0) ++sequence_.frames_out_of_order;
      sequence_.worst_disorder_s = std::max(sequence_.worst_disorder_s, behind_s);
      latest_s = std::max(latest_s, frame.time_s);
    }
    if (sequence_.frames_out_of_order > 0)
      std::stable_sort(sequence_.frames.begin(), sequence_.frames.end(),
                       [](const SequenceFrame& a, const SequenceFrame& b) { return a.time_s < b.time_s; });
  }

  void check_times() const {
    for (std::size_t f = 1; f < sequence_.frames.size(); ++f) {
      const SequenceFrame& frame = sequence_.frames[f];
      const double before_s = sequence_.frames[f - 1].time_s;
      if (frame.time_s == before_s) fail_time(frame, "repeats", before_s);
      if (frame.time_s - before_s > kLongestStep_s) fail_time(frame, "lies more than a day behind", before_s);
    }
  }

  [[noreturn]] void fail_time(const SequenceFrame& frame, const std::string& how, double before_s) const {
    char times[80];
    std::snprintf(times, sizeof times, "%.17g s after %.17g s", frame.time_s, before_s);
    fail(frame.number, "its Timestamp " + how + " that of the frame before it (" + times + ")");
  }

  CutBytes bytes_;
  bool is_nrrd_;
  Sequence sequence_;
  HeaderFields header_;
  std::vector<FrameField> fields_;
  std::unordered_map<std::string_view, int> name_indices_;
  std::optional<std::size_t> highest_frame_;  ///< highest frame that any field describes
  std::vector<Seen> seen_;
};

}  // namespace

const SequenceTransform* SequenceFrame::find(int name) const {
  const auto found = std::find_if(transforms.begin(), transforms.end(),
                                  [&](const SequenceTransform& transform) { return transform.name == name; });
  return found == transforms.end() ? nullptr : &*found;
}

int Sequence::find(std::string_view transform) const {
  const auto found = std::find(transform_names.begin(), transform_names.end(), transform);
  return found == transform_names.end() ? -1 : int(found - transform_names.begin());
}

Sequence parse_sequence(std::string_view bytes, const std::string& file) {
  return Parser(CutBytes::whole(bytes), file).parse();
}

Sequence parse_sequence(const CutBytes& bytes, const std::string& file) {
  return Parser(bytes, file).parse();
}

}  // namespace insonate
