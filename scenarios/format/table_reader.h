#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace insonate {

/// Returns the shortest text that restores the same number.
std::string plain(double number);

/// An inclusive range of numbers.
struct Range {
  double least;
  double most;
};

/// A table of the parsed text (table_node.h).
struct TableNode;

/// Reads keys from one table of a scenario and collects the problems. Its destructor reports keys that were never
/// requested. A missing or wrong value is reported and replaced by a harmless one, so that reading goes on.
class TableReader {
public:
  /// @param where  name of the table in messages: "step 2"
  TableReader(const TableNode& table, std::string where, std::vector<ScenarioProblem>& problems);
  ~TableReader();
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;

  /// Does not report keys that were never requested.
  void ignore_others() { ignores_others_ = true; }
  bool has(const char* key);
  void problem(const SourcePlace& place, const std::string& what, const std::string& remedy);
  SourcePlace place(const char* key) const;  ///< position of the key's value, or else of the table
  const std::string& where() const { return where_; }
  std::vector<ScenarioProblem>& problems() { return problems_; }

  std::string text(const char* key, bool required = true);
  /// Returns one of `words`. Returns the first if the key is missing and not required, or has another value.
  std::string choice(const char* key, const std::vector<std::string>& words, bool required = true);
  /// Returns a list of at most `most` texts, none of them empty. Returns an empty list if the key is missing and not
  /// required.
  std::vector<std::string> texts(const char* key, std::size_t most, bool required = true);
  double number(const char* key, const Range& range, std::optional<double> otherwise = std::nullopt);
  /// Returns two numbers [least, most] within `range`, or nothing if the key is missing.
  std::optional<Range> interval(const char* key, const Range& range);
  bool is_list(const char* key);
  /// Returns the element `index` of a list of three numbers.
  double one_of_three(const char* key, std::size_t index, const Range& range);
  bool yes_or_no(const char* key, bool otherwise);

  /// Returns the table under a key, named `where` in messages, or nullptr if it is missing.
  std::unique_ptr<TableReader> table(const char* key, bool required, const std::string& where);
  /// Returns at most `most` tables of an array of tables. In messages their names are `before`, the number and `after`.
  std::vector<std::unique_ptr<TableReader>> tables(const char* key, std::size_t most, const std::string& before,
                                                   const std::string& after);

  /// A key and its value. All values are empty if it is an array, a table, a date or not a finite number.
  struct Entry {
    std::string key;
    SourcePlace key_place, value_place;
    std::optional<std::string> text;
    std::optional<double> number;
    std::optional<bool> yes;
  };
  /// Returns all entries of the table in the order of the file. For tables with arbitrary keys.
  std::vector<Entry> entries();

private:
  void missing(const char* key, const std::string& example);

  std::unique_ptr<TableNode> table_;
  std::string where_;
  std::vector<ScenarioProblem>& problems_;
  std::set<std::string, std::less<>> asked_;
  bool ignores_others_ = false;
};

}  // namespace insonate
