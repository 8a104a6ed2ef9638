#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <unordered_map>

#include "devices/sequence/sequence.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

constexpr std::string_view kFramePrefix = "Seq_Frame";
constexpr std::string_view kTransform = "Transform";
constexpr std::string_view kTransformStatus = "TransformStatus";
// A tracked scan has a handful; the limit keeps the search within a frame short whatever the file holds.
constexpr std::size_t kMostTransforms = 256;
// The shortest line a frame needs, "Seq_Frame0_Timestamp=0\n": a file cannot hold more frames than such lines.
constexpr std::size_t kLeastFrameBytes = 23;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

bool same_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// `text` for a message: short, and without what a terminal could trip over.
std::string quoted(std::string_view text) {
  std::string shown = "'";
  for (const char c : text.substr(0, 40)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (text.size() > 40 ? "...'" : "'");
}

template <typename Number>
std::optional<Number> to_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> all;
  for (;;) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return all;
    text.remove_prefix(first);
    const std::size_t length = std::min(text.find_first_of(" \t"), text.size());
    all.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
}

/// Bytes an image element takes, by MetaIO's names (metaTypes.h; long is 4 bytes there); 0 for one that is unknown.
std::size_t element_bytes(std::string_view type) {
  static const std::unordered_map<std::string_view, std::size_t> sizes = {
      {"MET_CHAR", 1},  {"MET_UCHAR", 1},  {"MET_ASCII_CHAR", 1}, {"MET_SHORT", 2}, {"MET_USHORT", 2},
      {"MET_INT", 4},   {"MET_UINT", 4},   {"MET_LONG", 4},       {"MET_ULONG", 4}, {"MET_LONG_LONG", 8},
      {"MET_FLOAT", 4}, {"MET_DOUBLE", 8}, {"MET_ULONG_LONG", 8}, {"MET_OTHER", 1}, {"MET_NONE", 1}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

class Parser {
public:
  Parser(std::string_view bytes, const std::string& file) : bytes_(bytes) { sequence_.file = file; }

  Sequence parse() {
    read_lines();
    read_dimensions();
    find_images();
    make_frames();
    check_times();
    return std::move(sequence_);
  }

private:
  struct FrameField {
    std::size_t frame;
    std::string_view name;
    std::string_view value;
    std::size_t line;
  };

  [[noreturn]] void fail(const std::string& place, const std::string& problem, const std::string& remedy) const {
    throw InputError(sequence_.file, place, problem, remedy);
  }
  static std::string line_place(std::size_t line) { return "line " + std::to_string(line); }
  static std::string frame_place(std::size_t frame) { return "frame " + std::to_string(frame); }

  void read_lines() {
    if (bytes_.substr(0, 4) == "NRRD")
      fail("line 1", "this is a NRRD file, which is not read yet", "save the sequence as .igs.mha or .seq.mha");
    std::size_t line = 0;
    for (std::size_t at = 0; at < bytes_.size();) {
      const std::size_t end = std::min(bytes_.find('\n', at), bytes_.size());
      const std::string_view text = trimmed(bytes_.substr(at, end - at));
      at = std::min(end + 1, bytes_.size());
      ++line;
      if (text.empty() && line > 1) continue;
      const std::size_t equals = text.find('=');
      const std::string_view name = trimmed(text.substr(0, std::min(equals, text.size())));
      if (line == 1 && (equals == std::string_view::npos || (name != "ObjectType" && name != "NDims")))
        fail("line 1", "it starts neither with 'ObjectType = Image' nor with 'NDims = 3', as a MetaImage does",
             "give a sequence file (.igs.mha or .seq.mha)");
      if (equals == std::string_view::npos || name.empty())
        fail(line_place(line), quoted(text) + " is not of the form 'name = value'", "record or export the file again");
      const std::string_view value = trimmed(text.substr(equals + 1));
      if (name == "ElementDataFile") {
        data_file_ = value;
        sequence_.image_offset = at;
        if (value != "LOCAL")
          fail(line_place(line), "the image data is said to lie in " + quoted(value) + " instead of in this file",
               "save the sequence as one .igs.mha or .seq.mha file");
        return;
      }
      if (name.substr(0, kFramePrefix.size()) == kFramePrefix)
        read_frame_field(name.substr(kFramePrefix.size()), value, line);
      else
        read_header_field(name, value, line);
    }
    fail("header", "it ends without the line 'ElementDataFile = LOCAL': the file is truncated",
         "copy or record it again");
  }

  void read_frame_field(std::string_view rest, std::string_view value, std::size_t line) {
    const std::size_t underscore = rest.find('_');
    const auto frame = to_number<std::uint32_t>(rest.substr(0, std::min(underscore, rest.size())));
    if (underscore == std::string_view::npos || underscore + 1 == rest.size() || !frame)
      fail(line_place(line), quoted(std::string(kFramePrefix) + std::string(rest)) + " names no frame and field",
           "record or export the file again");
    const std::string_view name = rest.substr(underscore + 1);
    // Of the many fields a frame may have only these are kept; the others are the writer's own business.
    const bool known =
        name == "Timestamp" || name == "Buttons" || name.ends_with(kTransform) || name.ends_with(kTransformStatus);
    highest_frame_ = std::max<std::size_t>(highest_frame_, *frame);
    if (known) frame_fields_.push_back({*frame, name, value, line});
  }

  void read_header_field(std::string_view name, std::string_view value, std::size_t line) {
    static const std::set<std::string_view> known = {"ObjectType",     "NDims",   "BinaryData",
                                                     "CompressedData", "DimSize", "CompressedDataSize",
                                                     "ElementType",    "Kinds",   "ElementNumberOfChannels"};
    const bool transform = name.size() > kTransform.size() && name.ends_with(kTransform);
    if (!transform && !known.contains(name)) return;
    if (!header_.emplace(name, value).second)
      fail(line_place(line), "the field '" + std::string(name) + "' is given a second time",
           "record or export the file again");
    if (transform) {
      const auto matrix = to_matrix(value);
      if (!matrix)
        fail(line_place(line), "'" + std::string(name) + "' is not 16 finite numbers", "correct it in the header");
      name.remove_suffix(kTransform.size());
      sequence_.constants.emplace(name, *matrix);
    }
  }

  std::string_view header(std::string_view name) const {
    const auto found = header_.find(name);
    return found == header_.end() ? std::string_view{} : found->second;
  }

  static std::optional<glm::dmat4> to_matrix(std::string_view value) {
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

  bool flag(std::string_view name, bool otherwise) const {
    const std::string_view value = header(name);
    if (value.empty() && !header_.contains(name)) return otherwise;
    if (same_ignoring_case(value, "True")) return true;
    if (same_ignoring_case(value, "False")) return false;
    fail("header", "'" + std::string(name) + "' is " + quoted(value) + " instead of True or False",
         "record or export the file again");
  }

  /// Sets the number of frames and of bytes that their images take. Nothing is allocated by what is read here.
  void read_dimensions() {
    if (header_.contains("ObjectType") && header("ObjectType") != "Image")
      fail("header", "the object is " + quoted(header("ObjectType")) + " instead of an Image",
           "give a sequence file (.igs.mha or .seq.mha)");
    std::vector<std::uint64_t> sizes;
    for (const std::string_view word : words(header("DimSize"))) {
      const auto size = to_number<std::uint64_t>(word);
      if (!size || sizes.size() == 4)
        fail("header", "DimSize is " + quoted(header("DimSize")) + " instead of 3 or 4 sizes", "export the file again");
      sizes.push_back(*size);
    }
    const auto dimensions = to_number<std::uint32_t>(header("NDims"));
    if (!dimensions || sizes.size() != *dimensions || sizes.size() < 3)
      fail("header",
           "NDims is " + quoted(header("NDims")) + " and DimSize " + quoted(header("DimSize")) +
               ", where a sequence has 3 or 4 dimensions, the last of them its frames",
           "export the file again");

    std::size_t frame_axis = sizes.size() - 1;
    if (header_.contains("Kinds")) {
      const std::vector<std::string_view> kinds = words(header("Kinds"));
      const auto is_list = [](std::string_view kind) {
        return same_ignoring_case(kind, "list") || same_ignoring_case(kind, "time");
      };
      if (kinds.size() != sizes.size() || std::count_if(kinds.begin(), kinds.end(), is_list) != 1)
        fail("header",
             "Kinds is " + quoted(header("Kinds")) + ", where each of the " + std::to_string(sizes.size()) +
                 " dimensions has a kind and one of them is 'list'",
             "export the file again");
      frame_axis = std::size_t(std::find_if(kinds.begin(), kinds.end(), is_list) - kinds.begin());
    }
    frames_ = sizes[frame_axis];
    if (frames_ == 0) fail("header", "DimSize says that there are no frames", "record the scan again");
    if (frame_fields_.empty() || frames_ > bytes_.size() / kLeastFrameBytes || highest_frame_ >= frames_)
      fail("header",
           "DimSize says " + std::to_string(frames_) + " frames, but " +
               (frame_fields_.empty() ? "none is described, as in a plain image"
                                      : "frames up to number " + std::to_string(highest_frame_) + " are described"),
           "give a tracked sequence, or record it again");

    std::size_t element = 1;
    if (header_.contains("ElementType")) element = element_bytes(header("ElementType"));
    if (element == 0)
      fail("header", "ElementType is " + quoted(header("ElementType")) + ", which MetaImage does not know",
           "export the file again");
    std::uint64_t channels = 1;
    if (header_.contains("ElementNumberOfChannels")) {
      const auto given = to_number<std::uint64_t>(header("ElementNumberOfChannels"));
      if (!given || *given == 0)
        fail("header", "ElementNumberOfChannels is " + quoted(header("ElementNumberOfChannels")),
             "export the file again");
      channels = *given;
    }
    single_pixel_ = true;
    for (std::size_t axis = 0; axis < sizes.size(); ++axis)
      if (axis != frame_axis && sizes[axis] != 1) single_pixel_ = false;
    expected_bytes_ = 1;
    sizes.push_back(element);
    sizes.push_back(channels);
    if (std::find(sizes.begin(), sizes.end(), 0u) != sizes.end()) {
      expected_bytes_ = 0;
      return;
    }
    for (const std::uint64_t size : sizes) {
      if (expected_bytes_ > std::numeric_limits<std::uint64_t>::max() / size)
        fail("header", "DimSize " + quoted(header("DimSize")) + " is more than any file holds",
             "export the file again");
      expected_bytes_ *= size;
    }
  }

  void find_images() {
    const bool compressed = flag("CompressedData", false);
    if (!flag("BinaryData", true)) fail("header", "the image data is text", "export the file with BinaryData = True");
    if (expected_bytes_ == 0) return;
    const std::uint64_t there = bytes_.size() - sequence_.image_offset;
    // Transform-only files of PLUS say 1 x 1 and carry a pixel a frame; others say so and carry none (or a line end).
    if (single_pixel_ && (compressed || there <= 2)) return;
    std::uint64_t needed = expected_bytes_;
    if (compressed) {
      // Writers that fill the size in at the end leave 0 behind when they were stopped before.
      const auto size = to_number<std::uint64_t>(header("CompressedDataSize"));
      if (header_.contains("CompressedDataSize") && !size)
        fail("header", "CompressedDataSize is " + quoted(header("CompressedDataSize")), "export the file again");
      needed = std::max<std::uint64_t>(size.value_or(1), 1);
    }
    if (there < needed)
      fail("image data",
           "it is truncated: " + std::to_string(there) + " bytes of " + std::to_string(needed) + " are there",
           "copy or record the file again");
    sequence_.has_images = !single_pixel_;
    sequence_.image_bytes = std::size_t(needed);
  }

  int name_index(std::string_view name) {
    const auto [found, added] = name_indices_.emplace(name, int(sequence_.transform_names.size()));
    if (added) {
      if (sequence_.transform_names.size() == kMostTransforms)
        fail("header", "the frames have more than " + std::to_string(kMostTransforms) + " different transforms",
             "record only those of the probe");
      sequence_.transform_names.emplace_back(name);
    }
    return found->second;
  }

  SequenceTransform& transform(std::size_t frame, std::string_view name) {
    const int index = name_index(name);
    for (SequenceTransform& known : sequence_.frames[frame].transforms)
      if (known.name == index) return known;
    return sequence_.frames[frame].transforms.emplace_back(SequenceTransform{index});
  }

  void make_frames() {
    sequence_.frames.resize(std::size_t(frames_));
    std::vector<bool> timed(sequence_.frames.size());
    std::vector<bool> with_buttons(sequence_.frames.size());
    // Statuses first: whether a matrix has to make sense is theirs to say, and either line may come first.
    std::set<std::pair<std::size_t, int>> seen;
    for (const FrameField& field : frame_fields_) {
      if (!field.name.ends_with(kTransformStatus)) continue;
      const std::string_view name = field.name.substr(0, field.name.size() - kTransformStatus.size());
      SequenceTransform& stated = transform(field.frame, name);
      if (!seen.emplace(field.frame, stated.name).second) fail_twice(field);
      stated.status = status_from_igsio(field.value);
      if (stated.status == PoseStatus::switched)
        if (const char digit = switch_digit(field.value)) sequence_.frames[field.frame].buttons |= 1u << (digit - '1');
    }
    seen.clear();
    for (const FrameField& field : frame_fields_) {
      SequenceFrame& frame = sequence_.frames[field.frame];
      if (field.name == "Timestamp") {
        if (timed[field.frame]) fail_twice(field);
        timed[field.frame] = true;
        const auto time = to_number<double>(field.value);
        if (!time || !std::isfinite(*time))
          fail(frame_place(field.frame), "the Timestamp is " + quoted(field.value) + " instead of a finite number",
               "record the scan again");
        frame.time_s = *time;
      } else if (field.name == "Buttons") {
        if (with_buttons[field.frame]) fail_twice(field);
        with_buttons[field.frame] = true;
        const auto buttons = to_number<std::uint32_t>(field.value);
        if (!buttons)
          fail(frame_place(field.frame), "Buttons is " + quoted(field.value) + " instead of a whole number",
               "record the scan again");
        frame.buttons = *buttons;
      } else if (field.name.ends_with(kTransform)) {
        SequenceTransform& given = transform(field.frame, field.name.substr(0, field.name.size() - kTransform.size()));
        if (!seen.emplace(field.frame, given.name).second) fail_twice(field);
        if (given.status != PoseStatus::ok) continue;
        const auto matrix = to_matrix(field.value);
        if (!matrix)
          fail(frame_place(field.frame), std::string(field.name) + " is not 16 finite numbers",
               "record the scan again");
        given.matrix = *matrix;
      }
    }
    check_complete(timed, seen);
  }

  static char switch_digit(std::string_view word) {
    const std::size_t digit = word.find_first_of("123456789");
    return digit == std::string_view::npos ? '\0' : word[digit];
  }

  [[noreturn]] void fail_twice(const FrameField& field) const {
    fail(frame_place(field.frame),
         "'" + std::string(field.name) + "' is given a second time in line " + std::to_string(field.line),
         "record or export the file again");
  }

  void check_complete(const std::vector<bool>& timed, const std::set<std::pair<std::size_t, int>>& with_matrix) const {
    for (std::size_t f = 0; f < timed.size(); ++f) {
      if (!timed[f])
        fail(frame_place(f),
             "it has no Timestamp, of " + std::to_string(frames_) + " frames that DimSize says there are",
             "record the scan again");
      for (const SequenceTransform& transform : sequence_.frames[f].transforms)
        if (transform.status == PoseStatus::ok && !with_matrix.contains({f, transform.name}))
          fail(frame_place(f),
               "the status of " + sequence_.transform_names[std::size_t(transform.name)] +
                   " is OK, but the transform is not there",
               "record the scan again");
    }
  }

  void check_times() const {
    for (std::size_t f = 1; f < sequence_.frames.size(); ++f) {
      const double before = sequence_.frames[f - 1].time_s, now = sequence_.frames[f].time_s;
      if (now > before) continue;
      char times[80];
      std::snprintf(times, sizeof times, "%.17g s after %.17g s", now, before);
      fail(frame_place(f),
           std::string("its Timestamp ") + (now == before ? "repeats" : "goes back from") +
               " that of the frame before (" + times + ")",
           "record the scan again, or remove the frame");
    }
  }

  std::string_view bytes_;
  Sequence sequence_;
  std::string_view data_file_;
  std::map<std::string_view, std::string_view> header_;
  std::vector<FrameField> frame_fields_;
  std::unordered_map<std::string_view, int> name_indices_;
  std::size_t highest_frame_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t expected_bytes_ = 0;
  bool single_pixel_ = false;
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
  return Parser(bytes, file).parse();
}

}  // namespace insonate
