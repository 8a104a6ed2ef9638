#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/files/mistake.h"

namespace insonate {

struct TomlContents;
struct TomlNode;
class TomlTable;

/// The most parts of a dotted key in Insonate's files. The parser destroys nested tables recursively, so a key of some
/// 30,000 parts would overflow the stack.
inline constexpr int kMaxKeyParts = 16;

/// An inclusive range of numbers. By default it holds every finite number.
struct NumberRange {
  double least = std::numeric_limits<double>::lowest();
  double most = std::numeric_limits<double>::max();
};

/// Whether reading stops at the first mistake of a file or goes on to the last.
enum class OnMistake { throw_first, collect };

/// What a key of a table holds. Dates and times are `other`.
enum class TomlKind { missing, boolean, number, text, list, table, other };

/// A TOML file that a person wrote, parsed, and the mistakes found in it so far.
///
///     const TomlDocument document(file.string(), read_file(file));
///     const TomlTable root = document.root();
///     const double depth_mm = root.number("depth_mm", {20, 300});
///     for (const TomlTable& landmark : root.tables("landmark")) names.push_back(landmark.text("name"));
///     root.refuse_unknown_keys();
///
/// With OnMistake::throw_first, the constructor and each reader throw an InputError for the first mistake. With
/// OnMistake::collect they store the mistakes instead, and the reader calls throw_mistakes() at the end. A document and
/// its tables belong to one thread.
class TomlDocument {
public:
  /// Parses `text`. It is a mistake if the text is not TOML or a key has more than kMaxKeyParts parts; the root table
  /// is then empty. Throws std::bad_alloc if there is not enough memory.
  /// @param file  the name in error sentences
  TomlDocument(std::string file, std::string_view text, OnMistake on_mistake = OnMistake::throw_first);
  ~TomlDocument();
  TomlDocument(const TomlDocument&) = delete;
  TomlDocument& operator=(const TomlDocument&) = delete;

  /// Returns the table of the file's top level. The document must outlive every table.
  TomlTable root() const;

  /// Returns the collected mistakes in the order in which they were found.
  const std::vector<Mistake>& mistakes() const;

  /// Throws an InputError with all collected mistakes, if there are any.
  void throw_mistakes() const;

  /// The value of a text that stands where a number is expected, or what is wrong with it and what to do.
  struct Evaluation {
    std::optional<double> value;
    std::string problem, remedy;
  };
  /// From now on, readers of numbers accept texts too, and take the values that `evaluate` returns for them.
  void evaluate_texts(std::function<Evaluation(const std::string& text)> evaluate);

  /// Replaces every text under a key of the top level, at any depth, by what `replace` returns for it and its place.
  void replace_texts(std::string_view key,
                     const std::function<std::string(const std::string& text, const SourcePlace& place)>& replace);

private:
  std::unique_ptr<TomlContents> contents_;
};

/// A table of a TomlDocument, read key by key. It is a cheap handle: copies refer to the same table.
///
/// A reader without a default, the argument `otherwise`, reports a missing key as a mistake. Every reader reports a
/// value of another kind and a value out of range. If mistakes are collected, the reader then returns the default, or
/// else a harmless value within its range, so that reading goes on. Each mistake has the line and column of the value,
/// and its problem begins with name(). The document remembers which keys were asked for, by any function that takes a
/// key; refuse_unknown_keys() reports the others.
class TomlTable {
public:
  /// Returns the table's name in error sentences. It is empty for the top level, "[tip]" for a table under a key, and
  /// "hint 2 of step 1" for a table of the list [[step.hint]].
  const std::string& name() const;
  /// Gives the table another name in error sentences: "shape 'liver'".
  void rename(const std::string& name) const;

  bool has(std::string_view key) const { return kind(key) != TomlKind::missing; }
  TomlKind kind(std::string_view key) const;
  std::size_t list_length(std::string_view key) const;  ///< 0 if the key does not hold a list
  std::vector<std::string> keys() const;                ///< all keys, in the order of the file

  SourcePlace place(std::string_view key) const;      ///< of the key's value; of the table if the key is missing
  SourcePlace key_place(std::string_view key) const;  ///< of the key itself; of the table if the key is missing

  /// A number within `range`, whole or not. Not a number (nan) is out of every range.
  double number(std::string_view key, const NumberRange& range = {},
                std::optional<double> otherwise = std::nullopt) const;
  /// A number from `least` to `most`, written without a decimal point.
  std::int64_t whole_number(std::string_view key, std::int64_t least, std::int64_t most,
                            std::optional<std::int64_t> otherwise = std::nullopt) const;
  bool boolean(std::string_view key, std::optional<bool> otherwise = std::nullopt) const;
  /// A text. Without a default it must not be blank.
  std::string text(std::string_view key, const std::optional<std::string>& otherwise = std::nullopt) const;
  /// The index of a text among `words`.
  std::size_t choice(std::string_view key, const std::vector<std::string>& words,
                     std::optional<std::size_t> otherwise = std::nullopt) const;

  /// A list of `least` to `most` texts, none of them empty. With least = 0 the key may be missing.
  std::vector<std::string> texts(std::string_view key, std::size_t least = 0,
                                 std::size_t most = std::numeric_limits<std::size_t>::max()) const;
  /// A list of exactly `count` numbers within `range`.
  std::vector<double> numbers(std::string_view key, std::size_t count, const NumberRange& range = {}) const;
  /// A list of three numbers within `range`.
  glm::dvec3 vector(std::string_view key, const NumberRange& range = {},
                    const std::optional<glm::dvec3>& otherwise = std::nullopt) const;
  /// A list of at least `count` lists of `fewest` to `widest` numbers within `range`.
  std::vector<std::vector<double>> rows(std::string_view key, std::size_t count, std::size_t fewest, std::size_t widest,
                                        const NumberRange& range) const;
  /// A list of the least and the most number of a range that lies within `range`. Returns nothing if the key is missing
  /// or wrong.
  std::optional<NumberRange> interval(std::string_view key, const NumberRange& range) const;

  /// The table under a key. If mistakes are collected and there is none, its replacement is empty and reports nothing.
  TomlTable table(std::string_view key) const;
  /// The tables of a list, at most `most`; none if the key is missing.
  /// @param noun  names each table in error sentences: "label" gives "label 1"; the key, if empty
  std::vector<TomlTable> tables(std::string_view key, std::size_t most = std::numeric_limits<std::size_t>::max(),
                                std::string_view noun = {}) const;

  /// Reports a mistake in a key's value: throws it or stores it, as the document was opened. An empty key means the
  /// table itself.
  void report(std::string_view key, const std::string& problem, const std::string& remedy) const;
  void report_at(const SourcePlace& place, const std::string& problem, const std::string& remedy) const;
  /// Throws an InputError with this mistake and those that were collected before it.
  [[noreturn]] void fail(std::string_view key, const std::string& problem, const std::string& remedy) const;
  /// Returns the number of mistakes that are collected in the whole document.
  std::size_t mistake_count() const;
  /// Drops the collected mistakes of the whole document but the first `kept`.
  void forget_mistakes_after(std::size_t kept) const;

  /// Reports every key that was never asked for, here and in the tables that were read from this one. Call it when the
  /// table has been read; its suggestions are the keys that were asked for.
  void refuse_unknown_keys() const;
  /// Exempts this table from refuse_unknown_keys().
  void allow_unknown_keys() const;

private:
  friend class TomlDocument;
  explicit TomlTable(TomlNode& node) : node_(&node) {}

  TomlNode* node_;
};

}  // namespace insonate
