#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>

namespace insonate {

/// A URI that names a tracker: `scheme:subject?option=value&option=value`.
struct TrackerUri {
  std::string text;     ///< as given, for error messages
  std::string scheme;   ///< "replay"
  std::string subject;  ///< the part after the colon: a file, a seed or a host; may be empty
  std::map<std::string, std::string> options;

  /// Throws InputError if an option is given that is not among `names`.
  void allow_options(std::initializer_list<std::string_view> names) const;

  /// Returns the option as a number, or `otherwise` if it is not given. Throws InputError if it is not a number from
  /// `least` to `most`.
  double number(const std::string& option, double otherwise, double least, double most) const;

  /// Returns the option as 0 or 1, or `otherwise` if it is not given. Throws InputError if it is anything else.
  bool flag(const std::string& option, bool otherwise) const;
};

/// Splits a URI into its parts; the registry checks whether such a tracker exists. The last question mark starts the
/// options. Throws InputError if there is no scheme, if an option has no value, or if an option is given twice.
TrackerUri parse_tracker_uri(std::string_view text);

}  // namespace insonate
