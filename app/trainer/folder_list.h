#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/session/loaded_case.h"

namespace insonate {

/// What a person looks for: something to open, or a folder or file for the settings.
enum class Wanted {
  anything,
  patient,
  scenario,
  checked,  ///< a scenario, to see what is wrong with it
  recording,
  calibration,
  landmarks,
  drawing,
  look,
  cases,
  output,
  results
};

/// Returns whether a folder itself is looked for.
inline bool is_folder(Wanted wanted) {
  return wanted == Wanted::cases || wanted == Wanted::output;
}

/// One line of a folder's list.
struct FolderEntry {
  std::filesystem::path path;
  bool is_folder = false;      ///< a folder to go into; a case folder is not one
  std::string kind;            ///< in words: "CT", "case", "scenario or calibration"; empty for a plain folder
  std::uintmax_t bytes = 0;    ///< of a file
  std::int64_t changed_s = 0;  ///< since 1970 UTC; 0 if unknown
};

/// The folders and the files of one kind in a folder, for a person who looks for something to open.
struct FolderList {
  /// A folder with more entries is cut off there: nobody reads on.
  static constexpr std::size_t kMax = 2000;

  std::filesystem::path folder;      ///< absolute
  std::vector<FolderEntry> entries;  ///< folders first, each group in the order of names
  std::size_t left_out = 0;          ///< entries above kMax
  bool is_series = false;            ///< the folder itself holds DICOM files: it can be opened as a CT
  std::string problem;               ///< why it cannot be listed; empty if it can
};

/// Lists a folder. Names that begin with a dot are left out.
FolderList list_folder(const std::filesystem::path& folder, Wanted wanted);

/// Returns whether `path` is a folder to go into, rather than something to open: neither a case nor a DICOM series.
bool is_plain_folder(const std::filesystem::path& path);

/// Returns a path as a person types it, made absolute: "~" stands for the home folder.
std::filesystem::path typed_path(const std::string& typed);

/// Returns the parent folder; the folder itself at the root.
std::filesystem::path folder_above(const std::filesystem::path& folder);
std::filesystem::path home_folder();

/// Returns when a file was last changed, in seconds since 1970; 0 if it cannot be known.
std::int64_t changed_s(const std::filesystem::path& path);

/// Return a size and a time for a list: "84 MB", "2026-11-24 18:05" in the computer's own time.
std::string size_text(std::uintmax_t bytes);
std::string time_text(std::int64_t since_1970_s);

}  // namespace insonate
