#include "sim/volume/case.h"

#include <fcntl.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <set>
#include <stdexcept>
#include <system_error>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/files/toml_table.h"
#include "sim/files/toml_value.h"
#include "sim/volume/ct_reader.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;
constexpr std::size_t kLargestTable = 1u << 22;
constexpr double kFurthest_mm = 1e5;
constexpr const char* kTableFile = "case.toml";
constexpr const char* kCtFile = "ct.nrrd";
constexpr const char* kLabelsFile = "labels.nrrd";

template <typename Named>
const Named* find_named(const std::vector<Named>& all, std::string_view name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

/// Reads a name that other files and other entries refer to.
std::string read_identifier(const TomlTable& entry, std::string_view key) {
  const std::string name = entry.text(key);
  const bool plain = std::all_of(name.begin(), name.end(),
                                 [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '_'; });
  if (!plain)
    entry.fail(key, "'" + std::string(key) + "' is '" + name + "'", "use lower-case letters, digits and underscores");
  return name;
}

/// Reads the name of a file beside case.toml. A case can be moved as a whole, so it names nothing outside its folder.
fs::path read_file_name(const TomlTable& root, std::string_view key, const fs::path& folder) {
  const fs::path name = root.text(key);
  if (name != name.filename() || name == "." || name == "..")
    root.fail(key, "'" + std::string(key) + "' is '" + name.string() + "'", "name a file in the case's folder");
  return folder / name;
}

Label read_label(const TomlTable& entry) {
  return {std::uint8_t(entry.whole_number("value", 1, 255)), read_identifier(entry, "name"),
          read_identifier(entry, "tissue")};
}

Landmark read_landmark(const TomlTable& entry) {
  return {read_identifier(entry, "name"), entry.vector("position", {-kFurthest_mm, kFurthest_mm})};
}

ReferenceView read_view(const TomlTable& entry) {
  ReferenceView view;
  view.name = read_identifier(entry, "name");
  view.title = entry.text("title");
  view.probe = read_identifier(entry, "probe");
  view.depth_mm = entry.number("depth_mm", {20, 300});
  view.landmarks = entry.texts("landmarks");
  view.targets = entry.texts("targets");
  const std::vector<double> m = entry.numbers("patient_from_probe", 16);
  glm::dmat4 matrix;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) matrix[c][r] = m[std::size_t(4 * r + c)];
  if (const auto why = why_not_rigid(matrix))
    entry.fail("patient_from_probe", *why, "give a rotation and a translation");
  view.patient_from_probe = pose_from_matrix(matrix);
  return view;
}

template <typename Entry, typename Read>
std::vector<Entry> read_entries(const TomlTable& root, std::string_view key, Read read) {
  std::vector<Entry> all;
  for (const TomlTable& entry : root.tables(key)) {
    Entry one = read(entry);
    if (find_named(all, one.name)) entry.fail("name", "the name '" + one.name + "' is taken", "use each name once");
    all.push_back(std::move(one));
  }
  return all;
}

/// Refuses entries that contradict each other or refer to missing ones.
void check_references(const TomlTable& root, const Case& subject) {
  std::set<int> values;
  for (const TomlTable& entry : root.tables("label"))
    if (!values.insert(entry.whole_number("value", 1, 255)).second)
      entry.fail("value", "the value is taken by another label", "use each value once");
  const std::vector<std::string> landmarks = names_of(subject.landmarks), labels = names_of(subject.label_table);
  for (const TomlTable& entry : root.tables("view")) {
    for (const std::string& name : entry.texts("landmarks"))
      if (!subject.find_landmark(name))
        entry.fail("landmarks", "no landmark is called '" + name + "'", suggest(name, landmarks));
    for (const std::string& name : entry.texts("targets"))
      if (!subject.find_label(name)) entry.fail("targets", "no label is called '" + name + "'", suggest(name, labels));
  }
}

/// Refuses entries that contradict the volumes.
void check_volumes(const TomlTable& root, const Case& subject) {
  if (subject.labels.empty()) {
    if (!subject.label_table.empty())
      root.fail("label", "there are labels but no label volume", "add: labels = \"FILE\"");
    return;
  }
  const Grid &ct = subject.ct.grid, &labels = subject.labels.grid;
  if (labels.size != ct.size)
    root.fail("labels", "the labels have other sizes than the CT", "resample them onto the CT's grid");
  // Compare the corners: a small angle then counts by the distance it moves them.
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 index(corner & 1 ? ct.size.x - 1 : 0, corner & 2 ? ct.size.y - 1 : 0,
                           corner & 4 ? ct.size.z - 1 : 0);
    const double apart = glm::length(ct.patient_from_index(index) - labels.patient_from_index(index));
    if (apart > 0.1 * std::min({ct.spacing.x, ct.spacing.y, ct.spacing.z}))
      root.fail("labels", "the labels lie elsewhere in the patient than the CT", "resample them onto the CT's grid");
  }
  // A listed label without voxels is a finding that this patient lacks; a voxel without a listed label is a mistake.
  std::array<bool, 256> listed{};
  listed[0] = true;
  for (const Label& label : subject.label_table) listed[label.value] = true;
  std::array<bool, 256> present{};
  for (const std::uint8_t value : subject.labels.voxels) present[value] = true;
  for (std::size_t value = 0; value < present.size(); ++value)
    if (present[value] && !listed[value])
      root.fail("labels", "the label volume holds the value " + std::to_string(value) + ", which no [[label]] names",
                "add it to the table");
}

std::string view_table(const ReferenceView& view) {
  std::string out = "\n[[view]]\nname = " + toml_value(view.name) + "\ntitle = " + toml_value(view.title) +
                    "\nprobe = " + toml_value(view.probe) + "\ndepth_mm = " + toml_value(view.depth_mm) +
                    "\nlandmarks = " + toml_value(view.landmarks) + "\ntargets = " + toml_value(view.targets) +
                    "\npatient_from_probe = [\n";
  const glm::dmat4 m = view.patient_from_probe.matrix();
  for (int r = 0; r < 4; ++r) {
    out += " ";
    for (int c = 0; c < 4; ++c) out += " " + toml_value(m[c][r]) + ",";
    out += "\n";
  }
  return out + "]\n";
}

std::string case_table(const Case& subject) {
  std::string out = "# A case of Insonate: lengths in mm, positions in the patient's frame (LPS).\n";
  out += "format = " + std::to_string(kFormat) + "\n";
  out += "name = " + toml_value(subject.name) + "\n";
  out += "ct = " + toml_value(kCtFile) + "\n";
  if (!subject.labels.empty()) out += "labels = " + toml_value(kLabelsFile) + "\n";
  for (const Label& label : subject.label_table)
    out += "\n[[label]]\nvalue = " + std::to_string(label.value) + "\nname = " + toml_value(label.name) +
           "\ntissue = " + toml_value(label.tissue) + "\n";
  for (const Landmark& landmark : subject.landmarks) {
    const glm::dvec3& p = landmark.position;
    out += "\n[[landmark]]\nname = " + toml_value(landmark.name) +
           "\nposition = " + toml_value(std::vector{p.x, p.y, p.z}) + "\n";
  }
  for (const ReferenceView& view : subject.views) out += view_table(view);
  return out;
}

/// Reads all of case.toml except the volumes it names.
Case read_table(const TomlTable& root) {
  if (const std::int64_t format = root.whole_number("format", 1, 1 << 30); format != kFormat)
    root.fail(
        "format",
        "the case has format " + std::to_string(format) + ", this program knows format " + std::to_string(kFormat),
        "use a newer program");
  Case subject;
  subject.name = root.text("name");
  subject.label_table = read_entries<Label>(root, "label", read_label);
  subject.landmarks = read_entries<Landmark>(root, "landmark", read_landmark);
  subject.views = read_entries<ReferenceView>(root, "view", read_view);
  for (const char* key : {"ct", "labels"}) root.has(key);  // read when the rest of the table is right
  root.refuse_unknown_keys();
  check_references(root, subject);
  return subject;
}

/// Returns the name without a trailing slash, so that the temporary folder goes beside the folder.
fs::path without_slash(const fs::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

/// A temporary folder beside `target`. The destructor removes it unless it was renamed.
struct TemporaryFolder {
  fs::path path;
  explicit TemporaryFolder(const fs::path& target) : path(temporary_beside(target)) {
    remove_old_temporaries(target);
    std::error_code error;
    fs::create_directories(path, error);
    if (error)
      throw InputError(target.string(), "", "the folder cannot be made (" + error.message() + ")",
                       "name a folder that may be written");
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

/// Replaces folder `to` by folder `from`. Where the file system can swap two names, `from` holds the old content
/// afterwards, and `to` names the old content or the new one at any moment. Elsewhere the old folder is renamed first,
/// and restored if the replacement fails.
void replace_folder(const fs::path& from, const fs::path& to) {
  std::error_code error, ignored;
  if (!fs::exists(to, ignored)) {
    fs::rename(from, to, error);
  } else if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) != 0) {
    error.assign(errno, std::system_category());
    if (error == std::errc::invalid_argument || error == std::errc::function_not_supported) {
      fs::path old = from;
      old += ".old";
      fs::rename(to, old, error);
      if (!error) {
        fs::rename(from, to, error);
        if (error) fs::rename(old, to, ignored);
      }
      if (!error) fs::remove_all(old, ignored);
    }
  }
  if (error)
    throw InputError(to.string(), "", "it cannot be written (" + error.message() + ")",
                     "name a folder that may be written");
}

}  // namespace

const Label* Case::find_label(std::string_view label) const {
  return find_named(label_table, label);
}
const Landmark* Case::find_landmark(std::string_view landmark) const {
  return find_named(landmarks, landmark);
}
const ReferenceView* Case::find_view(std::string_view view) const {
  return find_named(views, view);
}

std::string read_case_name(const fs::path& folder) {
  const fs::path file = folder / kTableFile;
  return read_table(TomlDocument(file.string(), read_file(file, kLargestTable)).root()).name;
}

Case read_case(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InputError(folder.string(), "", "there is no such folder", "name a folder that holds a case.toml");
  const fs::path file = folder / kTableFile;
  const TomlDocument document(file.string(), read_file(file, kLargestTable));
  const TomlTable root = document.root();
  Case subject = read_table(root);
  // Read the volumes last: a mistake in the table is then reported without waiting for them.
  subject.ct = read_case_ct(read_file_name(root, "ct", folder));
  if (root.has("labels")) subject.labels = read_labels(read_file_name(root, "labels", folder));
  check_volumes(root, subject);
  return subject;
}

void append_view(const fs::path& folder, const ReferenceView& view) {
  const fs::path file = folder / kTableFile;
  std::string text = read_file(file, kLargestTable);
  if (text.back() != '\n') text += '\n';
  text += view_table(view);
  read_table(TomlDocument(file.string(), text).root());
  write_file(file, text);
}

void check_case_can_be_written(const fs::path& folder) {
  const fs::path target = without_slash(folder);
  const std::string name = target.filename().string();
  if (name.empty() || name == "." || name == "..")
    throw InputError(folder.string(), "", "it is not the name of a folder to make", "name a new folder");
  std::error_code error;
  if (fs::exists(target, error) && !fs::exists(target / kTableFile, error) &&
      !(fs::is_directory(target, error) && fs::is_empty(target, error)))
    throw InputError(target.string(), "", "something that is not a case is in the way", "name another folder");
  // The lowest existing parent folder must accept a new folder. Only a trial shows whether it does.
  fs::path above = fs::absolute(target, error).parent_path();
  while (above.has_relative_path() && !fs::exists(above, error)) above = above.parent_path();
  const fs::path trial = temporary_beside(above / name);
  fs::create_directory(trial, error);
  if (error)
    throw InputError(target.string(), "", "the folder cannot be made (" + error.message() + ")",
                     "name a folder that may be written");
  fs::remove(trial, error);
}

void write_case(const fs::path& folder, const Case& subject) {
  if (subject.ct.empty()) throw std::invalid_argument("write_case: the case has no CT");
  check_case_can_be_written(folder);
  const fs::path target = without_slash(folder);

  // Refuse to write what could not be read again: the table goes through the reader's own checks.
  const std::string table = case_table(subject);
  const TomlDocument document((target / kTableFile).string(), table);
  const TomlTable root = document.root();
  read_table(root);
  check_volumes(root, subject);

  const TemporaryFolder temporary(target);
  write_ct(temporary.path / kCtFile, subject.ct);
  if (!subject.labels.empty()) write_labels(temporary.path / kLabelsFile, subject.labels);
  write_file(temporary.path / kTableFile, table);
  replace_folder(temporary.path, target);
}

}  // namespace insonate
