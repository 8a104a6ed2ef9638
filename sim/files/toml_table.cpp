#include "sim/files/toml_table.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <map>
#include <new>
#include <set>
#include <utility>

#include "sim/core/suggest.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

SourcePlace place_of(const toml::source_region& source) {
  return {int(source.begin.line), int(source.begin.column)};
}

bool is_unbounded(const NumberRange& range) {
  return range.least == NumberRange().least && range.most == NumberRange().most;
}

double harmless(const NumberRange& range) {
  return is_unbounded(range) ? 0 : range.least;
}

std::string from_to(const NumberRange& range) {
  return " from " + exact_text(range.least) + " to " + exact_text(range.most);
}

std::string number_in(const NumberRange& range) {
  return is_unbounded(range) ? "a finite number" : "a number" + from_to(range);
}

/// Returns the end of the string that begins at `at`, one past its closing quotation marks. An unclosed single-line
/// string ends with the line.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view three = quote == '"' ? "\"\"\"" : "'''";
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

/// The characters that mean something to line_of_deep_key(). It skips all others.
constexpr std::array<bool, 256> kMarks = [] {
  std::array<bool, 256> marks{};
  for (const unsigned char mark : std::string_view("\"'#.\n=,[]{}")) marks[mark] = true;
  return marks;
}();

/// Returns the number, from 1, of the line whose dotted key has more than kMaxKeyParts parts; 0 if there is none.
int line_of_deep_key(std::string_view text) {
  int line = 1, dots = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (!kMarks[static_cast<unsigned char>(c)]) continue;
    if (c == '"' || c == '\'') {
      const std::size_t end = end_of_string(text, at);
      line += int(std::count(text.begin() + std::ptrdiff_t(at), text.begin() + std::ptrdiff_t(end), '\n'));
      at = end - 1;
    } else if (c == '#') {
      at = std::min(text.find('\n', at), text.size()) - 1;
    } else if (c == '.') {
      if (++dots >= kMaxKeyParts) return line;
    } else {
      dots = 0;
      line += c == '\n';
    }
  }
  return 0;
}

/// Parses TOML text. toml::parse() ends the program if an allocation fails in it. This function therefore allocates as
/// much memory beforehand, and throws std::bad_alloc if there is not enough.
toml::table parsed(std::string_view text, std::string_view name) {
  // A node takes some 200 bytes and its text at least 4, as "a=1" and a line end do.
  constexpr std::size_t kBytesPerByte = 64, kAtLeast = std::size_t(1) << 16;
  ::operator delete(::operator new(kAtLeast + kBytesPerByte * text.size()));
  return toml::parse(text, name);
}

}  // namespace

/// A table, and which of its keys were asked for.
struct TomlNode {
  TomlNode(TomlContents& contents, const toml::table& parsed) : document(contents), table(parsed) {}

  TomlContents& document;
  const toml::table& table;
  std::string name;              ///< in error sentences
  std::string path;              ///< as in its heading: "step.hint"
  std::string element;           ///< name of the innermost table of a list that holds it: "step 2"; may be its own
  bool allows_unknown = false;   ///< its unknown keys are not reported
  bool reports_nothing = false;  ///< it stands for a table that is missing
  std::set<std::string, std::less<>> asked;

  SourcePlace place(std::string_view key) const {
    const toml::node* value = table.get(key);
    return place_of(value ? value->source() : table.source());
  }
  Mistake mistake(const SourcePlace& at, const std::string& problem, const std::string& remedy) const {
    return {at, name.empty() ? problem : name + ": " + problem, remedy};
  }
  void report(const SourcePlace& at, const std::string& problem, const std::string& remedy) const;
  /// Returns the value of a key, or null.
  const toml::node* ask(std::string_view key) {
    asked.emplace(key);
    return table.get(key);
  }
  /// Returns the value of a key, or null. Reports a missing key unless it may be missing.
  const toml::node* find(std::string_view key, bool may_be_missing, const std::string& wanted);
  /// Returns the list under a key, or null, in the same way. Reports another value.
  const toml::array* find_list(std::string_view key, bool may_be_missing, const std::string& wanted);
  /// Reads the number in a node: the value of a key, or an element of its list. Reports any other value.
  std::optional<double> read_number(std::string_view key, const toml::node& value, const NumberRange& range,
                                    bool is_element, const std::string& remedy) const;
  TomlNode& below(const toml::table& child, std::string_view key) const;
};

struct TomlContents {
  std::string file;
  OnMistake on_mistake = OnMistake::throw_first;
  toml::table root;
  std::vector<Mistake> mistakes;
  std::map<const toml::table*, TomlNode> nodes;  ///< of the tables that were read
  std::function<TomlDocument::Evaluation(const std::string&)> evaluate;
  toml::table no_table;
  bool is_unreadable = false;  ///< it is not TOML, which is the only mistake: nothing is known of its keys

  TomlNode& node_of(const toml::table& table) { return nodes.try_emplace(&table, *this, table).first->second; }
  void add(Mistake mistake) {
    if (is_unreadable) return;
    if (on_mistake == OnMistake::throw_first) throw input_error(file, {std::move(mistake)});
    mistakes.push_back(std::move(mistake));
  }
};

void TomlNode::report(const SourcePlace& at, const std::string& problem, const std::string& remedy) const {
  if (!reports_nothing) document.add(mistake(at, problem, remedy));
}

const toml::node* TomlNode::find(std::string_view key, bool may_be_missing, const std::string& wanted) {
  const toml::node* value = ask(key);
  if (value || may_be_missing) return value;
  std::string remedy = "add it: " + wanted;
  for (const auto& [written, other] : table)
    if (!asked.contains(written.str()) && similar_name(written.str(), {std::string(key)}))
      remedy += ", or rename " + in_quotes(written.str()) + " if it is meant";
  report(place_of(table.source()), "the key " + in_quotes(key) + " is missing", remedy);
  return nullptr;
}

const toml::array* TomlNode::find_list(std::string_view key, bool may_be_missing, const std::string& wanted) {
  const toml::node* value = find(key, may_be_missing, wanted);
  if (value && !value->is_array()) report(place(key), in_quotes(key) + " is not a list", "write " + wanted);
  return value ? value->as_array() : nullptr;
}

std::optional<double> TomlNode::read_number(std::string_view key, const toml::node& value, const NumberRange& range,
                                            bool is_element, const std::string& remedy) const {
  const SourcePlace at = place_of(value.source());
  std::optional<double> number = value.value<double>();
  if (const auto* text = value.as_string(); text && document.evaluate) {
    const TomlDocument::Evaluation evaluation = document.evaluate(text->get());
    number = evaluation.value;
    if (!number) {
      report(at, evaluation.problem, evaluation.remedy);
      return std::nullopt;
    }
  }
  if (number && *number >= range.least && *number <= range.most) return number;  // not NaN
  report(at,
         in_quotes(key) + (is_element ? " holds " : " is ") +
             (number       ? exact_text(*number)
              : is_element ? "something that is not a number"
                           : "not a number"),
         remedy);
  return std::nullopt;
}

TomlNode& TomlNode::below(const toml::table& child, std::string_view key) const {
  TomlNode& node = document.node_of(child);
  node.path = (path.empty() ? "" : path + ".") + std::string(key);
  node.element = element;
  return node;
}

TomlDocument::TomlDocument(std::string file, std::string_view text, OnMistake on_mistake)
    : contents_(std::make_unique<TomlContents>()) {
  contents_->file = std::move(file);
  contents_->on_mistake = on_mistake;
  if (const int line = line_of_deep_key(text); line > 0) {
    contents_->add({{line, 1}, "a key has more than " + std::to_string(kMaxKeyParts) + " parts", "shorten it"});
    contents_->is_unreadable = true;
    return;
  }
  try {
    contents_->root = parsed(text, contents_->file);
  } catch (const toml::parse_error& error) {
    contents_->add(
        {place_of(error.source()), "this is not TOML: " + std::string(error.description()), "correct the line"});
    contents_->is_unreadable = true;
  }
}

TomlDocument::~TomlDocument() = default;

TomlTable TomlDocument::root() const {
  return TomlTable(contents_->node_of(contents_->root));
}

const std::vector<Mistake>& TomlDocument::mistakes() const {
  return contents_->mistakes;
}

void TomlDocument::throw_mistakes() const {
  if (!contents_->mistakes.empty()) throw input_error(contents_->file, contents_->mistakes);
}

void TomlDocument::evaluate_texts(std::function<Evaluation(const std::string&)> evaluate) {
  contents_->evaluate = std::move(evaluate);
}

void TomlDocument::replace_texts(std::string_view key,
                                 const std::function<std::string(const std::string&, const SourcePlace&)>& replace) {
  const std::function<void(toml::node&)> visit = [&](toml::node& node) {
    if (toml::table* table = node.as_table())
      for (auto&& [name, value] : *table) visit(value);
    else if (toml::array* array = node.as_array())
      for (toml::node& value : *array) visit(value);
    else if (auto* text = node.as_string())
      text->get() = replace(text->get(), place_of(node.source()));
  };
  if (toml::node* node = contents_->root.get(key)) visit(*node);
}

const std::string& TomlTable::name() const {
  return node_->name;
}

void TomlTable::rename(const std::string& name) const {
  if (node_->element == node_->name) node_->element = name;
  node_->name = name;
}

TomlKind TomlTable::kind(std::string_view key) const {
  const toml::node* value = node_->ask(key);
  if (!value) return TomlKind::missing;
  if (value->is_boolean()) return TomlKind::boolean;
  if (value->is_number()) return TomlKind::number;
  if (value->is_string()) return TomlKind::text;
  if (value->is_array()) return TomlKind::list;
  return value->is_table() ? TomlKind::table : TomlKind::other;
}

std::size_t TomlTable::list_length(std::string_view key) const {
  return kind(key) == TomlKind::list ? node_->table.get(key)->as_array()->size() : 0;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, value] : node_->table) {
    node_->asked.emplace(key.str());
    names.emplace_back(key.str());
  }
  std::sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    const SourcePlace first = key_place(a), second = key_place(b);
    return std::pair(first.line, first.column) < std::pair(second.line, second.column);
  });
  return names;
}

SourcePlace TomlTable::place(std::string_view key) const {
  return node_->place(key);
}

SourcePlace TomlTable::key_place(std::string_view key) const {
  const auto found = node_->table.find(key);
  return place_of(found == node_->table.end() ? node_->table.source() : found->first.source());
}

double TomlTable::number(std::string_view key, const NumberRange& range, std::optional<double> otherwise) const {
  const double fallback = otherwise.value_or(harmless(range));
  const toml::node* value = node_->find(key, otherwise.has_value(), number_in(range));
  if (!value) return fallback;
  return node_->read_number(key, *value, range, false, "give " + number_in(range)).value_or(fallback);
}

std::int64_t TomlTable::whole_number(std::string_view key, std::int64_t least, std::int64_t most,
                                     std::optional<std::int64_t> otherwise) const {
  const std::string wanted = least == most
                                 ? "the number " + std::to_string(least)
                                 : "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  if (const toml::node* value = node_->find(key, otherwise.has_value(), wanted)) {
    const auto* number = value->as_integer();
    if (number && number->get() >= least && number->get() <= most) return number->get();
    report(key, in_quotes(key) + " is " + (number ? std::to_string(number->get()) : "not a whole number"),
           "give " + wanted);
  }
  return otherwise.value_or(least);
}

bool TomlTable::boolean(std::string_view key, std::optional<bool> otherwise) const {
  if (const toml::node* value = node_->find(key, otherwise.has_value(), "true or false")) {
    if (const auto* boolean = value->as_boolean()) return boolean->get();
    report(key, in_quotes(key) + " is neither true nor false", "write true or false without quotation marks");
  }
  return otherwise.value_or(false);
}

std::string TomlTable::text(std::string_view key, const std::optional<std::string>& otherwise) const {
  if (const toml::node* value = node_->find(key, otherwise.has_value(), "a text between quotation marks")) {
    const auto* text = value->as_string();
    if (!text)
      report(key, in_quotes(key) + " is not a text", "put it between quotation marks");
    else if (!otherwise && trimmed(text->get()).empty())
      report(key, in_quotes(key) + " is empty", "write something between the quotation marks");
    else
      return text->get();
  }
  return otherwise.value_or("");
}

std::size_t TomlTable::choice(std::string_view key, const std::vector<std::string>& words,
                              std::optional<std::size_t> otherwise) const {
  std::string wanted;
  for (const std::string& word : words) wanted += (wanted.empty() ? "one of " : ", ") + in_quotes(word);
  node_->find(key, otherwise.has_value(), wanted);
  const std::string word = text(key, "");
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return std::size_t(found - words.begin());
  if (kind(key) == TomlKind::text) report(key, in_quotes(key) + " is " + in_quotes(word), suggest(word, words));
  return otherwise.value_or(0);
}

std::vector<std::string> TomlTable::texts(std::string_view key, std::size_t least, std::size_t most) const {
  const std::string wanted = "texts in square brackets, " + std::string(key) + " = [\"...\"]";
  std::vector<std::string> values;
  const toml::array* list = node_->find_list(key, least == 0, wanted);
  if (!list) return values;
  const std::size_t length = list->size();
  if (length < least)
    report(key, in_quotes(key) + (length == 0 ? " is empty" : " has too few texts"), "write " + wanted);
  if (length > most)
    report(key, in_quotes(key) + " has " + std::to_string(length) + " texts", "write at most " + std::to_string(most));
  for (const toml::node& element : *list) {
    const auto* text = element.as_string();
    if (!text || text->get().empty())
      report_at(place_of(element.source()),
                in_quotes(key) + " holds " + (text ? "an empty text" : "something that is not a text"),
                text ? "write something between the quotation marks" : "put it between quotation marks");
    else if (values.size() < most)
      values.push_back(text->get());
  }
  return values;
}

std::vector<double> TomlTable::numbers(std::string_view key, std::size_t count, const NumberRange& range) const {
  const std::string wanted = std::to_string(count) +
                             (is_unbounded(range) ? " finite numbers" : " numbers" + from_to(range)) +
                             " in square brackets";
  std::vector<double> values;
  if (const toml::array* list = node_->find_list(key, false, wanted)) {
    for (const toml::node& element : *list)
      values.push_back(node_->read_number(key, element, range, true, "write " + wanted).value_or(harmless(range)));
    if (values.size() != count)
      report(key, in_quotes(key) + " has " + std::to_string(values.size()) + " numbers", "write " + wanted);
  }
  values.resize(count, harmless(range));
  return values;
}

glm::dvec3 TomlTable::vector(std::string_view key, const NumberRange& range,
                             const std::optional<glm::dvec3>& otherwise) const {
  if (otherwise && !has(key)) return *otherwise;
  const std::vector<double> values = numbers(key, 3, range);
  return {values[0], values[1], values[2]};
}

std::vector<std::vector<double>> TomlTable::rows(std::string_view key, std::size_t count, std::size_t fewest,
                                                 std::size_t widest, const NumberRange& range) const {
  const std::string row_wanted =
      "a list of " + std::to_string(fewest) + (fewest == widest ? "" : " to " + std::to_string(widest)) + " numbers";
  const std::string wanted = "at least " + std::to_string(count) + " rows, each " + row_wanted;
  std::vector<std::vector<double>> values;
  const toml::array* list = node_->find_list(key, false, wanted);
  if (!list) return values;
  if (list->size() < count)
    report(key, in_quotes(key) + " has " + std::to_string(list->size()) + " rows", "write " + wanted);
  for (const toml::node& element : *list) {
    const toml::array* row = element.as_array();
    if (!row || row->size() < fewest || row->size() > widest) {
      report_at(place_of(element.source()), in_quotes(key) + " holds a row that is not " + row_wanted,
                "write " + wanted);
      continue;
    }
    values.emplace_back();
    for (const toml::node& value : *row)
      values.back().push_back(
          node_->read_number(key, value, range, true, "give " + number_in(range)).value_or(harmless(range)));
  }
  return values;
}

std::optional<NumberRange> TomlTable::interval(std::string_view key, const NumberRange& range) const {
  const toml::node* value = node_->ask(key);
  if (!value) return std::nullopt;
  if (const toml::array* list = value->as_array(); list && list->size() == 2) {
    const auto least = (*list)[0].value<double>(), most = (*list)[1].value<double>();
    if (least && most && *least >= range.least && *least <= *most && *most <= range.most)
      return NumberRange{*least, *most};
    if (least && most && *least <= *most && !is_unbounded(range)) {
      report(key, in_quotes(key) + " goes beyond its limits", "write two numbers" + from_to(range));
      return std::nullopt;
    }
    if (least && most && *least > *most && *most >= range.least && *least <= range.most) {
      report(key, in_quotes(key) + " begins with its larger number",
             "write [" + exact_text(*most) + ", " + exact_text(*least) + "]");
      return std::nullopt;
    }
  }
  report(key, in_quotes(key) + " is not a range",
         "write the least and the most in square brackets" + (is_unbounded(range) ? "" : "," + from_to(range)));
  return std::nullopt;
}

TomlTable TomlTable::table(std::string_view key) const {
  const std::string heading = "[" + (node_->path.empty() ? "" : node_->path + ".") + std::string(key) + "]";
  const toml::node* value = node_->find(key, false, heading);
  if (value && value->is_table()) {
    TomlNode& made = node_->below(*value->as_table(), key);
    made.name = heading + (made.element.empty() ? "" : " of " + made.element);
    return TomlTable(made);
  }
  if (value) report(key, in_quotes(key) + " is not a table", "write " + heading + " above its keys");
  TomlNode& none = node_->document.node_of(node_->document.no_table);
  none.reports_nothing = true;
  return TomlTable(none);
}

std::vector<TomlTable> TomlTable::tables(std::string_view key, std::size_t most, std::string_view noun) const {
  std::vector<TomlTable> all;
  const toml::node* value = node_->ask(key);
  if (!value) return all;
  const toml::array* list = value->as_array();
  if (!list || !std::all_of(list->begin(), list->end(), [](const toml::node& one) { return one.is_table(); })) {
    const std::string heading = "[[" + (node_->path.empty() ? "" : node_->path + ".") + std::string(key) + "]]";
    report(key, in_quotes(key) + " is not a list of tables", "write " + heading + " above the keys of each");
    return all;
  }
  if (list->size() > most)
    report(key, "there are " + std::to_string(list->size()) + " of " + in_quotes(key),
           "write at most " + std::to_string(most));
  for (const toml::node& element : *list) {
    if (all.size() == most) break;
    TomlNode& made = node_->below(*element.as_table(), key);
    made.name = std::string(noun.empty() ? key : noun) + " " + std::to_string(all.size() + 1) +
                (made.element.empty() ? "" : " of " + made.element);
    made.element = made.name;
    all.push_back(TomlTable(made));
  }
  return all;
}

void TomlTable::report(std::string_view key, const std::string& problem, const std::string& remedy) const {
  node_->report(place(key), problem, remedy);
}

void TomlTable::report_at(const SourcePlace& place, const std::string& problem, const std::string& remedy) const {
  node_->report(place, problem, remedy);
}

void TomlTable::fail(std::string_view key, const std::string& problem, const std::string& remedy) const {
  std::vector<Mistake> mistakes = node_->document.mistakes;
  mistakes.push_back(node_->mistake(place(key), problem, remedy));
  throw input_error(node_->document.file, std::move(mistakes));
}

std::size_t TomlTable::mistake_count() const {
  return node_->document.mistakes.size();
}

void TomlTable::forget_mistakes_after(std::size_t kept) const {
  std::vector<Mistake>& mistakes = node_->document.mistakes;
  if (kept < mistakes.size()) mistakes.erase(mistakes.begin() + std::ptrdiff_t(kept), mistakes.end());
}

void TomlTable::refuse_unknown_keys() const {
  for (const auto& [key, value] : node_->table) {
    if (!node_->asked.contains(key.str()) && !node_->allows_unknown)
      report_at(place_of(key.source()), "the key " + in_quotes(key.str()) + " is unknown here",
                suggest(key.str(), {node_->asked.begin(), node_->asked.end()}));
    const auto below = [&](const toml::node& node) {
      if (const toml::table* table = node.as_table())
        if (const auto read = node_->document.nodes.find(table); read != node_->document.nodes.end())
          TomlTable(read->second).refuse_unknown_keys();
    };
    below(value);
    if (const toml::array* list = value.as_array())
      for (const toml::node& element : *list) below(element);
  }
}

void TomlTable::allow_unknown_keys() const {
  node_->allows_unknown = true;
}

}  // namespace insonate
