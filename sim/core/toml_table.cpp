#include "sim/core/toml_table.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

std::string line_and_column(const toml::source_position& at) {
  return "line " + std::to_string(at.line) + ", column " + std::to_string(at.column);
}

/// Returns the end of the string that begins at `at`, one past its closing quotation marks. An unclosed single-line
/// string ends with the line.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string three(3, quote);
  const bool many_lines = text.substr(at).starts_with(three);
  for (at += many_lines ? 3 : 1; at < text.size(); ++at) {
    if (quote == '"' && text[at] == '\\')
      ++at;
    else if (!many_lines && text[at] == quote)
      return at + 1;
    else if (many_lines && text.substr(at).starts_with(three))
      return std::min(
          {text.find_first_not_of(quote, at), at + 5, text.size()});  // up to two more may belong to the text
    else if (!many_lines && text[at] == '\n')
      return at;
  }
  return text.size();
}

}  // namespace

toml::table parse_toml_text(std::string_view text, std::string_view name) {
  // A node takes some 200 bytes and its text at least 4, as "a=1" and a line end do.
  constexpr std::size_t kBytesPerByte = 64, kAtLeast = std::size_t(1) << 16;
  ::operator delete(::operator new(kAtLeast + kBytesPerByte * text.size()));
  return toml::parse(text, name);
}

int line_of_deep_key(std::string_view text) {
  int line = 1, dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    std::size_t end = at + 1;
    if (c == '"' || c == '\'')
      end = end_of_string(text, at);
    else if (c == '#')
      end = std::min(text.find('\n', at), text.size());
    else if (c == '.')
      ++dots;
    else if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos)
      dots = 0;
    if (dots >= kMostKeyParts) return line;
    line += int(std::count(text.begin() + std::ptrdiff_t(at), text.begin() + std::ptrdiff_t(end), '\n'));
    at = end;
  }
  return 0;
}

toml::table parse_toml(const std::string& file, std::string_view text) {
  if (const int line = line_of_deep_key(text); line > 0)
    throw InputError(file, "line " + std::to_string(line),
                     "a key has more than " + std::to_string(kMostKeyParts) + " parts between dots", "shorten it");
  try {
    return parse_toml_text(text, file);
  } catch (const toml::parse_error& error) {
    std::string problem(error.description());
    std::replace_if(
        problem.begin(), problem.end(), [](unsigned char c) { return c < ' '; }, ' ');
    throw InputError(file, line_and_column(error.source().begin), "this is not TOML: " + problem, "correct the line");
  }
}

void TomlTable::fail(std::string_view key, const std::string& problem, const std::string& remedy) const {
  const toml::node* node = key.empty() ? nullptr : table_->get(key);
  toml::source_position at = (node ? node : static_cast<const toml::node*>(table_))->source().begin;
  std::string place = at ? line_and_column(at) : "";
  if (!name_.empty()) place += (place.empty() ? "" : ", ") + name_;
  throw InputError(file_, place, problem, remedy);
}

void TomlTable::allow_only(const std::vector<std::string>& keys) const {
  for (const auto& [key, value] : *table_)
    if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
      fail(key.str(), "the key " + in_quotes(key.str()) + " is unknown here", suggest(key.str(), keys));
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, value] : *table_) names.emplace_back(key.str());
  return names;
}

const toml::node& TomlTable::required(std::string_view key, const char* kind) const {
  const toml::node* node = table_->get(key);
  if (!node) fail("", "the key " + in_quotes(key) + " is missing", std::string("add it: ") + kind);
  return *node;
}

double TomlTable::number(std::string_view key, double least, double most) const {
  const auto value = required(key, "a number").value<double>();
  if (!value || !(*value >= least && *value <= most))
    fail(key, in_quotes(key) + (value ? " is " + number_text(*value) : " is no number"),
         "give a number from " + number_text(least) + " to " + number_text(most));
  return *value;
}

int TomlTable::whole_number(std::string_view key, int least, int most) const {
  const auto* value = required(key, "a whole number").as_integer();
  if (!value || value->get() < least || value->get() > most)
    fail(key, in_quotes(key) + (value ? " is " + std::to_string(value->get()) : " is no whole number"),
         "give a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return int(value->get());
}

bool TomlTable::boolean(std::string_view key) const {
  const auto* value = required(key, "true or false").as_boolean();
  if (!value) fail(key, in_quotes(key) + " is neither true nor false", "write true or false without quotes");
  return value->get();
}

std::string TomlTable::text(std::string_view key) const {
  const auto* value = required(key, "a text in quotes").as_string();
  if (!value || value->get().empty()) fail(key, in_quotes(key) + " is no text", "write a text in quotes");
  return value->get();
}

std::vector<double> TomlTable::numbers(std::string_view key, int count) const {
  const std::string wanted = std::to_string(count) + " numbers in square brackets";
  const toml::array* array = required(key, wanted.c_str()).as_array();
  if (!array) fail(key, in_quotes(key) + " is no list", "write " + wanted);
  std::vector<double> values;
  for (const toml::node& element : *array) {
    const auto value = element.value<double>();
    if (!value || !std::isfinite(*value))
      fail(key, in_quotes(key) + " holds something that is no finite number", "write " + wanted);
    values.push_back(*value);
  }
  if (values.size() != std::size_t(count))
    fail(key, in_quotes(key) + " has " + std::to_string(values.size()) + " numbers", "write " + wanted);
  return values;
}

std::vector<std::string> TomlTable::texts(std::string_view key) const {
  std::vector<std::string> values;
  if (!has(key)) return values;
  const toml::array* array = table_->get(key)->as_array();
  if (!array) fail(key, in_quotes(key) + " is no list", "write texts in square brackets");
  for (const toml::node& element : *array) {
    const auto* value = element.as_string();
    if (!value || value->get().empty())
      fail(key, in_quotes(key) + " holds something that is no text", "put each in quotes");
    values.push_back(value->get());
  }
  return values;
}

TomlTable TomlTable::table(std::string_view key) const {
  const toml::table* table = required(key, "a table").as_table();
  if (!table) fail(key, in_quotes(key) + " is no table", "write it as [" + std::string(key) + "]");
  return {file_, (name_.empty() ? "[" : name_ + " [") + std::string(key) + "]", *table};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  std::vector<TomlTable> all;
  if (!has(key)) return all;
  const toml::array* array = table_->get(key)->as_array();
  const std::string heading = "[[" + std::string(key) + "]]";
  if (!array) fail(key, in_quotes(key) + " is no list of tables", "write each as " + heading);
  for (const toml::node& element : *array) {
    if (!element.is_table())
      fail(key, in_quotes(key) + " holds something that is no table", "write each as " + heading);
    all.emplace_back(file_, heading + " " + std::to_string(all.size() + 1), *element.as_table());
  }
  return all;
}

}  // namespace insonate
