#include "app/trainer/folder_list.h"

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/held_files.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

bool is_dicom(const fs::path& file) {
  constexpr int kPreamble = 128;
  const std::string name = lower(file.filename().string());
  if (name == "dicomdir" || name.ends_with(".dcm") || name.ends_with(".ima")) return true;
  if (is_held(file)) return false;
  char mark[4] = {};
  std::ifstream in(file, std::ios::binary);
  return in.seekg(kPreamble) && in.read(mark, sizeof mark) && std::string_view(mark, sizeof mark) == "DICM";
}

/// A series has thousands of files, so only the first ones are looked at.
bool holds_dicom(const fs::path& folder) {
  constexpr int kLookedAt = 8;
  std::error_code error;
  int files = 0;
  for (fs::directory_iterator at(folder, error), end; !error && at != end && files < kLookedAt; at.increment(error)) {
    if (!at->is_regular_file(error)) continue;
    if (is_dicom(at->path())) return true;
    ++files;
  }
  return false;
}

std::optional<Material> material_of(const fs::path& path) {
  try {
    return kind_of_material(path);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Returns what the entry is in words; empty if it is not wanted.
std::string kind_in_words(Material material, Wanted wanted) {
  const bool any = wanted == Wanted::anything;
  switch (material) {
    case Material::case_folder:
      return any || wanted == Wanted::patient ? "case" : "";
    case Material::ct:
      return any || wanted == Wanted::patient ? "CT" : "";
    case Material::scenario:  // every .toml
      return wanted == Wanted::calibration                                    ? "calibration"
             : wanted == Wanted::landmarks                                    ? "landmarks"
             : wanted == Wanted::drawing                                      ? "drawing"
             : wanted == Wanted::look                                         ? "transfer function"
             : any || wanted == Wanted::scenario || wanted == Wanted::checked ? "scenario"
                                                                              : "";
    case Material::tracker_log:
      return any || wanted == Wanted::recording ? "recorded scan" : "";
    case Material::raw_log:
      return any ? "tracker's bytes" : "";
  }
  return "";
}

/// The file's voxels are not read for a list, so its name decides.
bool is_named_as_labels(const fs::path& file) {
  const std::string name = lower(file.filename().string());
  return name.find("labels") != std::string::npos || name.find("segmentation") != std::string::npos ||
         name.find("_seg.") != std::string::npos;
}

/// Returns nothing for what is not shown.
std::optional<FolderEntry> entry_of(const fs::directory_entry& found, Wanted wanted) {
  std::error_code error;
  FolderEntry entry;
  entry.path = found.path();
  if (found.is_directory(error)) {
    const bool is_case = fs::exists(entry.path / "case.toml", error);
    entry.is_folder = !is_case || (wanted != Wanted::anything && wanted != Wanted::patient);
    if (!entry.is_folder) entry.kind = "case";
  } else {
    if (is_folder(wanted)) return std::nullopt;
    const std::optional<Material> material = wanted == Wanted::results ? std::nullopt : material_of(entry.path);
    if (material) entry.kind = kind_in_words(*material, wanted);
    if (entry.kind == "CT" && is_named_as_labels(entry.path)) entry.kind = "labels";
    if (wanted == Wanted::results && entry.path.extension() == ".db") entry.kind = "results";
    if (entry.kind.empty()) return std::nullopt;
    entry.bytes = found.file_size(error);
    if (error) entry.bytes = 0;
  }
  entry.changed_s = changed_s(entry.path);
  return entry;
}

}  // namespace

FolderList list_folder(const fs::path& folder, Wanted wanted) {
  FolderList list;
  std::error_code error;
  list.folder = fs::weakly_canonical(folder, error);
  if (error || list.folder.empty()) list.folder = folder;
  fs::directory_iterator at(list.folder, error);
  if (error) {
    list.problem = list.folder.string() + ": " + error.message() + "; choose another folder.";
    return list;
  }
  for (const fs::directory_iterator end; !error && at != end; at.increment(error)) {
    if (at->path().filename().string().starts_with(".")) continue;
    if (std::optional<FolderEntry> entry = entry_of(*at, wanted)) list.entries.push_back(std::move(*entry));
  }
  list.is_series = (wanted == Wanted::anything || wanted == Wanted::patient) && holds_dicom(list.folder);
  std::sort(list.entries.begin(), list.entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    if (a.is_folder != b.is_folder) return a.is_folder;
    return lower(a.path.filename().string()) < lower(b.path.filename().string());
  });
  if (list.entries.size() > FolderList::kMax) {
    list.left_out = list.entries.size() - FolderList::kMax;
    list.entries.resize(FolderList::kMax);
  }
  return list;
}

bool is_plain_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) && !fs::exists(path / "case.toml", error) && !holds_dicom(path);
}

fs::path home_folder() {
  const char* const home = std::getenv("HOME");
  return home && *home ? fs::path(home) : fs::path("/");
}

fs::path typed_path(const std::string& typed) {
  if (typed == "~") return home_folder();
  if (typed.starts_with("~/")) return home_folder() / typed.substr(2);
  std::error_code error;
  const fs::path absolute = fs::absolute(typed, error);
  return error ? fs::path(typed) : absolute;
}

fs::path folder_above(const fs::path& folder) {
  const fs::path parent = folder.parent_path();
  return parent.empty() ? folder : parent;
}

std::string size_text(std::uintmax_t bytes) {
  constexpr const char* kUnits[] = {"B", "kB", "MB", "GB", "TB"};
  double size = double(bytes);
  std::size_t unit = 0;
  for (; size >= 999.5 && unit + 1 < std::size(kUnits); ++unit) size /= 1000;
  return formatted("%.0f %s", size, kUnits[unit]);
}

std::int64_t changed_s(const fs::path& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? std::int64_t(status.st_mtime) : 0;
}

std::string time_text(std::int64_t since_1970_s) {
  if (since_1970_s == 0) return "";
  const std::time_t time = std::time_t(since_1970_s);
  std::tm local{};
  if (!localtime_r(&time, &local)) return "";
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local);
  return text;
}

}  // namespace insonate
