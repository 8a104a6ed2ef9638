#include "scenarios/results/roster.h"

#include <map>

#include "scenarios/results/learner_id.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

/// An id and its position in the file.
struct Entry {
  std::string id;
  std::string place;
};

std::vector<Entry> entries_of_toml(const std::string& file, const std::string& text) {
  const TomlDocument document(file, text);
  const TomlTable table = document.root();
  table.whole_number("format", 1, 1);
  std::vector<Entry> entries;
  for (const std::string& id : table.texts("learners"))
    entries.push_back({id, "learners, number " + std::to_string(entries.size() + 1)});
  table.refuse_unknown_keys();
  return entries;
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

/// Removes the quotes of a CSV cell, if it has any.
std::string_view unquoted(std::string_view cell) {
  return cell.size() >= 2 && cell.front() == '"' && cell.back() == '"' ? cell.substr(1, cell.size() - 2) : cell;
}

std::vector<Entry> entries_of_csv(const std::string& file, std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // spreadsheets write it at the start
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<Entry> entries;
  bool headed = false;
  // Stops once the limit is exceeded, so that a far too long file is not stored.
  for (std::size_t line = 1; !text.empty() && entries.size() <= kMaxLearners; ++line) {
    const std::size_t end = text.find('\n');
    const std::string_view cell = unquoted(without_blanks(text.substr(0, end)));
    text = end == std::string_view::npos ? "" : text.substr(end + 1);
    if (cell.empty()) continue;
    const std::string place = "line " + std::to_string(line);
    if (!headed) {
      if (cell != "learner")
        throw InputError(file, place, "the first line is not the header 'learner'",
                         "write that word there and one id on each line below it, without other columns");
      headed = true;
    } else {
      entries.push_back({std::string(cell), place});
    }
  }
  return entries;
}

}  // namespace

std::vector<std::string> read_roster(const std::filesystem::path& file) {
  constexpr std::size_t kLargest = std::size_t(16) << 20;
  const std::string text = read_file(file, kLargest), name = file.string();
  const std::vector<Entry> entries =
      file.extension() == ".toml" ? entries_of_toml(name, text) : entries_of_csv(name, text);
  if (entries.empty()) throw InputError(name, "", "it lists no learners", "write their ids into it");
  if (entries.size() > kMaxLearners)
    throw InputError(name, "", "the number of its learners is above the limit of " + std::to_string(kMaxLearners),
                     "check that it is the right file");
  std::map<std::string, std::string> places;
  std::vector<std::string> ids;
  for (const Entry& entry : entries) {
    check_learner_id(entry.id, name, entry.place);
    const auto [before, first_time] = places.emplace(entry.id, entry.place);
    if (!first_time)
      throw InputError(name, entry.place, "'" + entry.id + "' stands at " + before->second + " already",
                       "give each learner an id of their own");
    ids.push_back(entry.id);
  }
  return ids;
}

}  // namespace insonate
