#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/pictures/ct_look.h"
#include "app/trainer/look.h"
#include "app/trainer/options.h"

namespace insonate {

/// What a person sets once for their computer. None of it changes a score: it is how things look and where files go.
struct Preferences {
  Look look;
  CtLook ct;
  std::string quality = name_of(Quality::balanced);  ///< of the ultrasound: one of quality_names()
  std::string igtl_server;                           ///< "[ADDRESS:]PORT" for OpenIGTLink clients; empty: no server
  std::filesystem::path out;                         ///< reports, pictures and recordings; empty: "out", here
  std::filesystem::path cases;                       ///< whose case folders the start page lists; empty: none
  std::filesystem::path results;                     ///< the database; empty: the user's own

  // What the person used last, and the start page offers again
  static constexpr std::size_t kMaxPatients = 8;
  std::vector<std::filesystem::path> patients;  ///< CTs and case folders, the newest last
  std::string network_tracker;                  ///< URI; empty: none

  bool operator==(const Preferences&) const = default;
};

/// Returns $XDG_CONFIG_HOME/insonate/settings.toml, else $HOME/.config/insonate/settings.toml. Throws InputError if
/// neither variable is set.
std::filesystem::path preferences_file();

/// Returns whether a path can stand in such a file: TOML holds Unicode alone, and names of files hold any bytes.
bool can_be_kept(const std::filesystem::path& path);

/// Reads preferences; the defaults if there is no such file. Throws InputError for a file that cannot be used.
Preferences read_preferences(const std::filesystem::path& file);
/// Writes preferences so that read_preferences() returns them. Throws InputError if the file cannot be written.
void write_preferences(const std::filesystem::path& file, const Preferences& preferences);

/// Fills in quality and folder where the command line does not name them.
Options with_preferences(Options options, const Preferences& preferences);

}  // namespace insonate
