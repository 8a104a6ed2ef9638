#include "scenarios/results/database/comment.h"

#include <optional>

#include "scenarios/results/learner_id.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

/// Takes the first character off UTF-8 text. Returns nothing, and leaves the text, if it does not begin with one:
/// overlong forms, surrogates and values above U+10FFFF are not characters.
std::optional<char32_t> take_character(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc2 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  if (length == 0 || length > text.size()) return std::nullopt;
  char32_t character = length == 1 ? first : first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0u) != 0x80) return std::nullopt;
    character = character << 6 | (byte(i) & 0x3fu);
  }
  constexpr char32_t kMin[] = {0, 0, 0x80, 0x800, 0x10000};
  if (character < kMin[length] || character > 0x10ffff || (character >= 0xd800 && character < 0xe000))
    return std::nullopt;
  text.remove_prefix(length);
  return character;
}

}  // namespace

std::string why_no_comment(std::string_view text) {
  std::size_t characters = 0;
  bool blank = true;
  while (!text.empty()) {
    const std::optional<char32_t> character = take_character(text);
    ++characters;
    if (!character) return "character " + std::to_string(characters) + " of the comment is not UTF-8";
    if (*character == '\n' || *character == '\r')
      return "character " + std::to_string(characters) + " of the comment is a line break";
    if (*character < 0x20 || (*character >= 0x7f && *character < 0xa0))
      return "character " + std::to_string(characters) + " of the comment is a control character";
    blank = blank && *character == ' ';
  }
  if (blank) return "the comment is empty";
  if (characters > Comment::kMaxCharacters)
    return "the comment has " + std::to_string(characters) + " characters, above the limit of " +
           std::to_string(Comment::kMaxCharacters);
  return {};
}

void check_comment(const Comment& comment, const std::string& file) {
  if (!comment.author.empty()) check_learner_id(comment.author, file, "author");
  if (const std::string why = why_no_comment(comment.text); !why.empty())
    throw InputError(file, "comment", why,
                     "write one paragraph of at most " + std::to_string(Comment::kMaxCharacters) + " characters");
}

}  // namespace insonate
