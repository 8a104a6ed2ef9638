#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// Parses TOML text. toml::parse() ends the program if an allocation fails in it. This function therefore allocates as
/// much memory beforehand, and throws std::bad_alloc if there is not enough. Throws toml::parse_error for text that is
/// not TOML.
toml::table parse_toml_text(std::string_view text, std::string_view name = {});

/// The most parts of a dotted key in Insonate's files. The parser destroys nested tables recursively, so a key of some
/// 30,000 parts would overflow the stack.
inline constexpr int kMostKeyParts = 16;

/// Returns the number, from 1, of the line whose dotted key has more than kMostKeyParts parts; 0 if there is none. Call
/// it before parsing a text.
int line_of_deep_key(std::string_view text);

/// Parses TOML text. Throws InputError with line and column if the text is not TOML or a key has too many parts.
toml::table parse_toml(const std::string& file, std::string_view text);

/// Reads a table of a TOML file, written by a person, key by key. A value that is missing, of the wrong type or out of
/// range throws an InputError that names the file, line, column and key. Refers to the parsed table, which must outlive
/// it. A library whose sources include this header links tomlplusplus.
class TomlTable {
public:
  /// @param name  the table's name in messages: "[[knot]] 3"; empty for the file's top level
  TomlTable(std::string file, std::string name, const toml::table& table)
      : file_(std::move(file)), name_(std::move(name)), table_(&table) {}

  /// Throws InputError for every key that is not listed, and suggests the listed key that it resembles.
  void allow_only(const std::vector<std::string>& keys) const;

  bool has(std::string_view key) const { return table_->contains(key); }
  const std::string& name() const { return name_; }
  std::vector<std::string> keys() const;

  double number(std::string_view key, double least, double most) const;
  int whole_number(std::string_view key, int least, int most) const;
  bool boolean(std::string_view key) const;
  std::string text(std::string_view key) const;                        ///< not empty
  std::vector<double> numbers(std::string_view key, int count) const;  ///< finite
  std::vector<std::string> texts(std::string_view key) const;          ///< empty if the key is missing
  TomlTable table(std::string_view key) const;                         ///< [key]
  std::vector<TomlTable> tables(std::string_view key) const;           ///< [[key]]; empty if the key is missing

  /// Throws the InputError about a key's value; an empty key means the table itself.
  [[noreturn]] void fail(std::string_view key, const std::string& problem, const std::string& remedy) const;

private:
  const toml::node& required(std::string_view key, const char* kind) const;

  std::string file_;
  std::string name_;
  const toml::table* table_;
};

}  // namespace insonate
