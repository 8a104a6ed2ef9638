#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// toml::parse(), which ends the program when an allocation fails in it. So this asks for the memory beforehand, and
/// throws std::bad_alloc when it is not to be had. Throws toml::parse_error besides.
toml::table parse_toml_text(std::string_view text, std::string_view name = {});

/// The most parts that a dotted key may have in a file of Insonate's. A table of tables is taken apart recursively: a
/// key of some 30,000 parts would overflow the stack.
inline constexpr int kMostKeyParts = 16;

/// The line in which a dotted key has more than kMostKeyParts parts, from 1; 0 when there is none. To be asked before
/// a text is parsed.
int line_of_deep_key(std::string_view text);

/// Parses TOML text. Throws InputError with line and column when it is none, and for keys of too many parts.
toml::table parse_toml(const std::string& file, std::string_view text);

/// A table of a TOML file that a person wrote, read key by key. Whatever is missing, of the wrong type or out of range
/// throws an InputError that names the file, line, column and key. Keeps a reference to the parsed table. A room that
/// includes this header links tomlplusplus.
class TomlTable {
public:
  /// @param name  what messages call the table: "[[knot]] 3"; empty for the file's top level
  TomlTable(std::string file, std::string name, const toml::table& table)
      : file_(std::move(file)), name_(std::move(name)), table_(&table) {}

  /// Refuses every key that is not listed, with the listed key it resembles.
  void allow_only(const std::vector<std::string>& keys) const;

  bool has(std::string_view key) const { return table_->contains(key); }
  const std::string& name() const { return name_; }
  std::vector<std::string> keys() const;

  double number(std::string_view key, double least, double most) const;
  int whole_number(std::string_view key, int least, int most) const;
  bool boolean(std::string_view key) const;
  std::string text(std::string_view key) const;                        ///< not empty
  std::vector<double> numbers(std::string_view key, int count) const;  ///< finite
  std::vector<std::string> texts(std::string_view key) const;          ///< none when the key is missing
  TomlTable table(std::string_view key) const;                         ///< [key]
  std::vector<TomlTable> tables(std::string_view key) const;           ///< [[key]]; none when the key is missing

  /// Throws the InputError that complains about a key's value; an empty key means the table.
  [[noreturn]] void fail(std::string_view key, const std::string& problem, const std::string& remedy) const;

private:
  const toml::node& required(std::string_view key, const char* kind) const;

  std::string file_;
  std::string name_;
  const toml::table* table_;
};

}  // namespace insonate
