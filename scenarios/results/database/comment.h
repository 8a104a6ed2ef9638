#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace insonate {

/// What an instructor has written about an attempt. It is stored beside the attempt, which never changes.
struct Comment {
  std::int64_t number = 0;      ///< number in its database, from 1; 0 until it is stored in one
  std::int64_t attempt = 0;     ///< number of the attempt
  std::string author;           ///< an opaque id (learner_id.h); empty if the author is not named
  std::int64_t written_ms = 0;  ///< since 1970 UTC, as Attempt::finished_ms
  std::string text;             ///< UTF-8 without control characters

  /// The longest text, in characters. It keeps a report readable.
  static constexpr std::size_t kMaxCharacters = 2000;
};

/// Returns what is wrong with a comment's text, as the problem part of an InputError. Returns an empty text for a valid
/// one: 1 to kMaxCharacters characters of UTF-8, not all blank, without line breaks and other control characters.
std::string why_no_comment(std::string_view text);

/// Throws InputError if the text is not valid, or if the author is neither empty nor an opaque id.
/// @param file  where the comment comes from: "command line"
void check_comment(const Comment& comment, const std::string& file);

}  // namespace insonate
