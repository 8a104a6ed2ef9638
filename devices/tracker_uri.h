#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>

namespace insonate {

/// What a person names a tracker by: `scheme:subject?option=value&option=value`.
struct TrackerUri {
  std::string text;     ///< as given, for messages
  std::string scheme;   ///< "replay"
  std::string subject;  ///< what follows the colon: a file, a seed, a host; may be empty
  std::map<std::string, std::string> options;

  /// Throws InputError when an option is given that is not among `names`.
  void allow_options(std::initializer_list<std::string_view> names) const;

  /// The option as a number, or `otherwise` when it is not given. Throws InputError when it is no number from `least`
  /// to `most`.
  double number(const std::string& option, double otherwise, double least, double most) const;

  /// The option as 0 or 1, or `otherwise` when it is not given. Throws InputError when it is anything else.
  bool flag(const std::string& option, bool otherwise) const;
};

/// Takes a URI apart; whether there is such a tracker is the registry's to say. The last question mark starts the
/// options. Throws InputError when there is no scheme, an option has no value, or one is given twice.
TrackerUri parse_tracker_uri(std::string_view text);

}  // namespace insonate
