#pragma once

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/core/toml_table.h"
#include "sim/model/settings_file.h"

/// Maps a struct of settings to keys of a TOML file. settings_file.cpp and wein_settings_file.cpp share it.
namespace insonate::keys {

constexpr std::size_t kLargestFile = 1u << 20;

/// Returns a text such as "from 0.5 to 30".
std::string from_to(double least, double most);
std::string in_words(const SettingValue& value);
/// Returns a TOML value converted to the same kind as `kind`; nothing if it is of another kind.
std::optional<SettingValue> value_of(const toml::node& node, const SettingValue& kind);

/// Collects errors instead of stopping at the first one, at most kMostReported: a file of another kind may have an
/// error in every line.
class Problems {
public:
  static constexpr int kMostReported = 100;

  template <typename Check>
  /// Runs `check` and stores the InputError that it throws, if any.
  void note(Check&& check) {
    if (told_ >= kMostReported) return;
    try {
      check();
    } catch (const InputError& error) {
      sentences_ += (sentences_.empty() ? "" : "\n") + std::string(error.what());
      ++told_;
    }
  }
  /// Throws one InputError with all stored errors, if there are any.
  void throw_any() const {
    if (!sentences_.empty()) throw InputError(sentences_);
  }

private:
  std::string sentences_;
  int told_ = 0;
};

/// Describes a setting of S for files and messages.
template <typename S>
struct Key {
  std::string name;
  std::string wanted;  ///< the accepted values: "a whole number from 1 to 8192"
  std::function<SettingValue(const S&)> get;
  std::function<void(S&, const SettingValue&)> set;  ///< requires an allowed value
  std::function<bool(const SettingValue&)> allowed;  ///< requires a value of the right kind
};

template <typename S>
Key<S> flag(const char* name, bool S::*member) {
  return {name, "true or false", [=](const S& s) { return s.*member; },
          [=](S& s, const SettingValue& value) { s.*member = std::get<bool>(value); },
          [](const SettingValue&) { return true; }};
}

template <typename S, typename Integer>
Key<S> whole(const char* name, Integer S::*member, Integer least, Integer most, bool odd = false) {
  // Not by %g, which would round the largest numbers.
  const std::string range = "from " + std::to_string(least) + " to " + std::to_string(most);
  return {name, (odd ? "an odd number " : "a whole number ") + range,
          [=](const S& s) { return std::int64_t(s.*member); },
          [=](S& s, const SettingValue& value) { s.*member = Integer(std::get<std::int64_t>(value)); },
          [=](const SettingValue& value) {
            const std::int64_t n = std::get<std::int64_t>(value);
            return n >= std::int64_t(least) && n <= std::int64_t(most) && (!odd || n % 2 != 0);
          }};
}

template <typename S>
Key<S> number(const char* name, double S::*member, double least, double most) {
  return {name, "a number " + from_to(least, most), [=](const S& s) { return s.*member; },
          [=](S& s, const SettingValue& value) { s.*member = std::get<double>(value); },
          [=](const SettingValue& value) {
            const double x = std::get<double>(value);
            return x >= least && x <= most;  // false for NaN
          }};
}

template <typename S, std::size_t N>
Key<S> numbers(const char* name, std::array<double, N> S::*member, double least, double most) {
  return {name, "a list of " + std::to_string(N) + " numbers " + from_to(least, most),
          [=](const S& s) { return std::vector<double>((s.*member).begin(), (s.*member).end()); },
          [=](S& s, const SettingValue& value) {
            std::copy_n(std::get<std::vector<double>>(value).begin(), N, (s.*member).begin());
          },
          [=](const SettingValue& value) {
            const auto& list = std::get<std::vector<double>>(value);
            return list.size() == N &&
                   std::all_of(list.begin(), list.end(), [&](double x) { return x >= least && x <= most; });
          }};
}

/// @param names  the names of the enumerators, in their order
template <typename S, typename Enum>
Key<S> choice(const char* name, Enum S::*member, const std::vector<std::string>& names) {
  std::string wanted;
  for (std::size_t i = 0; i < names.size(); ++i)
    wanted += (i == 0 ? "'" : i + 1 == names.size() ? " or '" : ", '") + names[i] + "'";
  return {name, wanted,
          [=](const S& s) {
            const std::size_t index = std::size_t(s.*member);
            return index < names.size() ? names[index] : "number " + std::to_string(index);
          },
          [=](S& s, const SettingValue& value) {
            s.*member = Enum(std::find(names.begin(), names.end(), std::get<std::string>(value)) - names.begin());
          },
          [=](const SettingValue& value) {
            return std::find(names.begin(), names.end(), std::get<std::string>(value)) != names.end();
          }};
}

/// Returns the defaults of `S` overridden by the file's values. Adds every unknown key, wrong kind and value out of
/// range to `problems`.
/// @param others  keys of the file that do not belong to S
template <typename S>
S written_in(const TomlTable& root, const toml::table& parsed, const std::vector<Key<S>>& keys,
             const std::vector<std::string>& others, Problems& problems) {
  std::vector<std::string> known = others;
  for (const Key<S>& key : keys) known.push_back(key.name);
  for (const std::string& name : root.keys())
    if (std::find(known.begin(), known.end(), name) == known.end())
      problems.note([&] { root.fail(name, "the key " + in_quotes(name) + " is unknown here", suggest(name, known)); });
  S written;
  for (const Key<S>& key : keys) {
    if (!root.has(key.name)) continue;
    problems.note([&] {
      const auto value = value_of(*parsed.get(key.name), key.get(written));
      if (!value) root.fail(key.name, in_quotes(key.name) + " is of another kind", "give " + key.wanted);
      if (!key.allowed(*value))
        root.fail(key.name, in_quotes(key.name) + " is " + in_words(*value), "give " + key.wanted);
      key.set(written, *value);
    });
  }
  return written;
}

template <typename S>
std::optional<std::string> first_not_valid(const std::vector<Key<S>>& keys, const S& settings) {
  for (const Key<S>& key : keys)
    if (const SettingValue value = key.get(settings); !key.allowed(value))
      return in_quotes(key.name) + " is " + in_words(value) + ", not " + key.wanted;
  return std::nullopt;
}

template <typename S>
std::vector<std::pair<std::string, SettingValue>> named(const std::vector<Key<S>>& keys, const S& settings) {
  std::vector<std::pair<std::string, SettingValue>> all;
  for (const Key<S>& key : keys) all.emplace_back(key.name, key.get(settings));
  return all;
}

}  // namespace insonate::keys
