#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace insonate {

/// As short as it can be said without losing a bit.
std::string plain(double number);

struct Range {
  double least;
  double most;
};

/// A table of the parsed text; table_node.h.
struct TableNode;

/// Takes keys out of one table of a scenario, collects what is wrong with them, and at its end complains of keys nobody
/// asked for. What is missing or wrong is reported and replaced by something harmless, so that reading goes on.
class TableReader {
public:
  /// @param where  what to call the table in a sentence: "step 2"
  TableReader(const TableNode& table, std::string where, std::vector<ScenarioProblem>& problems);
  ~TableReader();
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;

  /// Keys that nobody asks for are not complained of.
  void ignore_others() { ignores_others_ = true; }
  bool has(const char* key);
  void problem(const SourcePlace& place, const std::string& what, const std::string& remedy);
  SourcePlace place(const char* key) const;  ///< of the key's value, or else of the table
  const std::string& where() const { return where_; }
  std::vector<ScenarioProblem>& problems() { return problems_; }

  std::string text(const char* key, bool required = true);
  /// One of the words listed; the first of them when the key is missing and not required, or holds something else.
  std::string choice(const char* key, const std::vector<std::string>& words, bool required = true);
  /// Texts in square brackets, each of them not empty, up to `most`; none when the key is missing and not required.
  std::vector<std::string> texts(const char* key, std::size_t most, bool required = true);
  double number(const char* key, const Range& range, std::optional<double> otherwise = std::nullopt);
  /// Two numbers [least, most] within `range`; empty when the key is missing.
  std::optional<Range> interval(const char* key, const Range& range);
  bool is_list(const char* key);
  /// The `index`th of three numbers in square brackets.
  double one_of_three(const char* key, std::size_t index, const Range& range);
  bool yes_or_no(const char* key, bool otherwise);

  /// The table under a key, called `where`; nullptr when there is none.
  std::unique_ptr<TableReader> table(const char* key, bool required, const std::string& where);
  /// The tables of an array of tables, at most `most`, called `before`, their number and `after`.
  std::vector<std::unique_ptr<TableReader>> tables(const char* key, std::size_t most, const std::string& before,
                                                   const std::string& after);

  /// A key and its value, which is none of these when it is an array, a table, a date or no finite number.
  struct Entry {
    std::string key;
    SourcePlace key_place, value_place;
    std::optional<std::string> text;
    std::optional<double> number;
    std::optional<bool> yes;
  };
  /// All of the table, in the order of the file, for tables whose keys are free.
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
