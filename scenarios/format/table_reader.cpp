#include "scenarios/format/table_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <new>

#include "scenarios/format/table_node.h"
#include "sim/core/suggest.h"

namespace insonate {
namespace {

SourcePlace place_of(const toml::source_region& source) {
  return {int(source.begin.line), int(source.begin.column)};
}

bool is_number(const toml::node& node) {
  return node.is_integer() || (node.is_floating_point() && std::isfinite(**node.as_floating_point()));
}

}  // namespace

std::string plain(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

TableReader::TableReader(const TableNode& table, std::string where, std::vector<ScenarioProblem>& problems)
    : table_(std::make_unique<TableNode>(table)), where_(std::move(where)), problems_(problems) {}

TableReader::~TableReader() {
  if (ignores_others_) return;
  try {
    for (const auto& [key, node] : *table_->table)
      if (!asked_.contains(key.str()))
        problems_.push_back({place_of(key.source()), where_ + " has an unknown key '" + std::string(key.str()) + "'",
                             suggest(key.str(), {asked_.begin(), asked_.end()})});
  } catch (const std::bad_alloc&) {
    // A destructor must not throw. This code runs only for a file with an error, and its caller needs memory too.
  }
}

bool TableReader::has(const char* key) {
  asked_.insert(key);
  return table_->table->contains(key);
}

void TableReader::problem(const SourcePlace& place, const std::string& what, const std::string& remedy) {
  problems_.push_back({place, where_ + " " + what, remedy});
}

SourcePlace TableReader::place(const char* key) const {
  const toml::node* node = table_->table->get(key);
  return place_of(node ? node->source() : table_->table->source());
}

void TableReader::missing(const char* key, const std::string& example) {
  problem(place_of(table_->table->source()), "lacks the key '" + std::string(key) + "'",
          "add " + std::string(key) + " = " + example);
}

std::string TableReader::text(const char* key, bool required) {
  const toml::node* node = has(key) ? table_->table->get(key) : nullptr;
  if (!node) {
    if (required) missing(key, "\"...\"");
    return {};
  }
  const auto value = node->value_exact<std::string>();
  if (!value) problem(place(key), "has a '" + std::string(key) + "' that is no text", "put it between quotation marks");
  if (value && required && value->find_first_not_of(" \t\r\n") == std::string::npos)
    problem(place(key), "has an empty '" + std::string(key) + "'", "write something between the quotation marks");
  return value.value_or("");
}

std::string TableReader::choice(const char* key, const std::vector<std::string>& words, bool required) {
  const std::size_t problems_before = problems_.size();
  const std::string word = text(key, required);
  const bool known = std::find(words.begin(), words.end(), word) != words.end();
  if (!known && has(key) && problems_.size() == problems_before)
    problem(place(key), "has " + std::string(key) + " = '" + word + "', which does not exist", suggest(word, words));
  return known ? word : words.front();
}

std::vector<std::string> TableReader::texts(const char* key, std::size_t most, bool required) {
  const toml::node* node = has(key) ? table_->table->get(key) : nullptr;
  if (!node) {
    if (required) missing(key, "[\"...\"]");
    return {};
  }
  const std::string name = "has a '" + std::string(key) + "' ";
  const toml::array* array = node->as_array();
  if (!array || array->empty()) {
    problem(place(key), name + (array ? "that is empty" : "that is no list"),
            "write texts in square brackets, " + std::string(key) + " = [\"...\"]");
    return {};
  }
  if (array->size() > most)
    problem(place(key), name + "of " + std::to_string(array->size()), "keep to " + std::to_string(most) + " at most");
  std::vector<std::string> values;
  for (const toml::node& one : *array) {
    const auto value = one.value_exact<std::string>();
    if (!value || value->empty())
      problem(place_of(one.source()), name + "with something that is no text", "put it between quotation marks");
    else if (values.size() < most)
      values.push_back(*value);
  }
  return values;
}

double TableReader::number(const char* key, const Range& range, std::optional<double> otherwise) {
  const toml::node* node = has(key) ? table_->table->get(key) : nullptr;
  if (!node) {
    if (!otherwise) missing(key, "a number");
    return otherwise.value_or(range.least);
  }
  const auto value = is_number(*node) ? node->value<double>() : std::nullopt;
  if (!value) {
    problem(place(key), "has a '" + std::string(key) + "' that is no number",
            "write a number from " + plain(range.least) + " to " + plain(range.most));
    return otherwise.value_or(range.least);
  }
  if (!(*value >= range.least && *value <= range.most)) {
    problem(place(key), "has " + std::string(key) + " = " + plain(*value),
            "choose from " + plain(range.least) + " to " + plain(range.most));
    return otherwise.value_or(range.least);
  }
  return *value;
}

std::optional<Range> TableReader::interval(const char* key, const Range& range) {
  const toml::node* node = has(key) ? table_->table->get(key) : nullptr;
  if (!node) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array && array->size() == 2 && is_number((*array)[0]) && is_number((*array)[1])) {
    const Range given{*(*array)[0].value<double>(), *(*array)[1].value<double>()};
    if (given.least >= range.least && given.least <= given.most && given.most <= range.most) return given;
  }
  problem(place(key), "has a '" + std::string(key) + "' that is no range",
          "write the least and the most in square brackets, from " + plain(range.least) + " to " + plain(range.most));
  return std::nullopt;
}

bool TableReader::is_list(const char* key) {
  return has(key) && table_->table->get(key)->is_array();
}

double TableReader::one_of_three(const char* key, std::size_t index, const Range& range) {
  const toml::array& array = *table_->table->get(key)->as_array();
  const auto in_range = [&](const toml::node& node) {
    return is_number(node) && *node.value<double>() >= range.least && *node.value<double>() <= range.most;
  };
  if (array.size() == 3 && std::all_of(array.begin(), array.end(), in_range)) return *array[index].value<double>();
  problem(place(key), "has a '" + std::string(key) + "' that is not three numbers",
          "write three from " + plain(range.least) + " to " + plain(range.most));
  return range.least;
}

bool TableReader::yes_or_no(const char* key, bool otherwise) {
  const toml::node* node = has(key) ? table_->table->get(key) : nullptr;
  if (!node) return otherwise;
  const auto value = node->value_exact<bool>();
  if (!value)
    problem(place(key), "has a '" + std::string(key) + "' that is neither true nor false", "write true or false");
  return value.value_or(otherwise);
}

std::unique_ptr<TableReader> TableReader::table(const char* key, bool required, const std::string& where) {
  const toml::node* node = has(key) ? table_->table->get(key) : nullptr;
  if (!node) {
    if (required) missing(key, "a table");
    return nullptr;
  }
  if (!node->is_table()) {
    problem(place(key), "has a '" + std::string(key) + "' that is no table",
            "write [" + std::string(key) + "] above its keys");
    return nullptr;
  }
  return std::make_unique<TableReader>(TableNode{node->as_table()}, where, problems_);
}

std::vector<std::unique_ptr<TableReader>> TableReader::tables(const char* key, std::size_t most,
                                                              const std::string& before, const std::string& after) {
  std::vector<std::unique_ptr<TableReader>> found;
  const toml::node* node = has(key) ? table_->table->get(key) : nullptr;
  if (!node) return found;
  const toml::array* array = node->as_array();
  const bool all_tables =
      array && std::all_of(array->begin(), array->end(), [](const auto& n) { return n.is_table(); });
  if (!all_tables) {
    problem(place(key), "has a '" + std::string(key) + "' that is no list of tables",
            "write it in two brackets, [[" + std::string(key) + "]]");
    return found;
  }
  if (array->size() > most)
    problem(place(key), "has " + std::to_string(array->size()) + " of '" + key + "'",
            "keep to " + std::to_string(most) + " at most");
  for (const toml::node& one : *array)
    if (found.size() < most)
      found.push_back(std::make_unique<TableReader>(TableNode{one.as_table()},
                                                    before + std::to_string(found.size() + 1) + after, problems_));
  return found;
}

std::vector<TableReader::Entry> TableReader::entries() {
  std::vector<Entry> all;
  for (const auto& [key, node] : *table_->table) {
    Entry entry;
    entry.key = std::string(key.str());
    entry.key_place = place_of(key.source());
    entry.value_place = place_of(node.source());
    entry.text = node.template value_exact<std::string>();
    entry.yes = node.template value_exact<bool>();
    if (is_number(node)) entry.number = node.template value<double>();
    asked_.insert(entry.key);
    all.push_back(std::move(entry));
  }
  std::sort(all.begin(), all.end(), [](const Entry& a, const Entry& b) {
    return std::pair(a.key_place.line, a.key_place.column) < std::pair(b.key_place.line, b.key_place.column);
  });
  return all;
}

}  // namespace insonate
