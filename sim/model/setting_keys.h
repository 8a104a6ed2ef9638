#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "sim/core/text.h"
#include "sim/files/toml_table.h"
#include "sim/model/settings_file.h"

/// Maps a struct of settings to keys of a TOML file. settings_file.cpp and wein_settings_file.cpp share it.
namespace insonate::keys {

constexpr std::size_t kLargestFile = 1u << 20;

/// Returns a text such as "from 0.5 to 30".
std::string from_to(double least, double most);
std::string in_words(const SettingValue& value);

/// Describes a setting of S for files and messages.
template <typename S>
struct Key {
  std::string name;
  std::string wanted;  ///< the accepted values: "a whole number from 1 to 8192"
  std::function<SettingValue(const S&)> get;
  std::function<void(const TomlTable&, S&)> read;    ///< the file has the key
  std::function<bool(const SettingValue&)> allowed;  ///< requires a value of the right kind
  std::function<void(const SettingValue&, S&)> set;  ///< requires a value that is allowed
};

template <typename S>
Key<S> flag(const char* name, bool S::*member) {
  return {name,
          "true or false",
          [=](const S& s) { return s.*member; },
          [=](const TomlTable& file, S& s) { s.*member = file.boolean(name); },
          [](const SettingValue&) { return true; },
          [=](const SettingValue& value, S& s) { s.*member = std::get<bool>(value); }};
}

template <typename S, typename Integer>
Key<S> whole(const char* name, Integer S::*member, Integer least, Integer most, bool odd = false) {
  const std::string wanted = (odd ? "an odd number " : "a whole number ") + from_to(double(least), double(most));
  return {name,
          wanted,
          [=](const S& s) { return std::int64_t(s.*member); },
          [=](const TomlTable& file, S& s) {
            s.*member = Integer(file.whole_number(name, std::int64_t(least), std::int64_t(most)));
            if (odd && s.*member % 2 == 0)
              file.report(name, in_quotes(name) + " is " + std::to_string(s.*member), "give " + wanted);
          },
          [=](const SettingValue& value) {
            const std::int64_t n = std::get<std::int64_t>(value);
            return n >= std::int64_t(least) && n <= std::int64_t(most) && (!odd || n % 2 != 0);
          },
          [=](const SettingValue& value, S& s) { s.*member = Integer(std::get<std::int64_t>(value)); }};
}

template <typename S>
Key<S> number(const char* name, double S::*member, double least, double most) {
  return {name,
          "a number " + from_to(least, most),
          [=](const S& s) { return s.*member; },
          [=](const TomlTable& file, S& s) {
            s.*member = file.number(name, {least, most});
          },
          [=](const SettingValue& value) {
            const double x = std::get<double>(value);
            return x >= least && x <= most;  // false for NaN
          },
          [=](const SettingValue& value, S& s) { s.*member = std::get<double>(value); }};
}

template <typename S, std::size_t N>
Key<S> numbers(const char* name, std::array<double, N> S::*member, double least, double most) {
  return {name,
          "a list of " + std::to_string(N) + " numbers " + from_to(least, most),
          [=](const S& s) { return std::vector<double>((s.*member).begin(), (s.*member).end()); },
          [=](const TomlTable& file, S& s) {
            std::copy_n(file.numbers(name, N, {least, most}).begin(), N, (s.*member).begin());
          },
          [=](const SettingValue& value) {
            const auto& list = std::get<std::vector<double>>(value);
            return list.size() == N &&
                   std::all_of(list.begin(), list.end(), [&](double x) { return x >= least && x <= most; });
          },
          [=](const SettingValue& value, S& s) {
            std::copy_n(std::get<std::vector<double>>(value).begin(), N, (s.*member).begin());
          }};
}

/// @param names  the names of the enumerators, in their order
template <typename S, typename Enum>
Key<S> choice(const char* name, Enum S::*member, const std::vector<std::string>& names) {
  std::string wanted;
  for (std::size_t i = 0; i < names.size(); ++i)
    wanted += (i == 0 ? "'" : i + 1 == names.size() ? " or '" : ", '") + names[i] + "'";
  return {name,
          wanted,
          [=](const S& s) {
            const std::size_t index = std::size_t(s.*member);
            return index < names.size() ? names[index] : "number " + std::to_string(index);
          },
          [=](const TomlTable& file, S& s) { s.*member = Enum(file.choice(name, names)); },
          [=](const SettingValue& value) {
            return std::find(names.begin(), names.end(), std::get<std::string>(value)) != names.end();
          },
          [=](const SettingValue& value, S& s) {
            s.*member = Enum(std::find(names.begin(), names.end(), std::get<std::string>(value)) - names.begin());
          }};
}

/// Replaces the fields of `settings` that the file has keys for.
template <typename S>
void read_keys(const TomlTable& file, const std::vector<Key<S>>& keys, S& settings) {
  for (const Key<S>& key : keys)
    if (file.has(key.name)) key.read(file, settings);
}

template <typename S>
std::optional<std::string> first_not_valid(const std::vector<Key<S>>& keys, const S& settings) {
  for (const Key<S>& key : keys)
    if (const SettingValue value = key.get(settings); !key.allowed(value))
      return in_quotes(key.name) + " is " + in_words(value) + ", not " + key.wanted;
  return std::nullopt;
}

/// As set_setting().
template <typename S>
std::optional<std::string> set_named(const std::vector<Key<S>>& keys, S& settings, const std::string& name,
                                     SettingValue value) {
  const auto key = std::find_if(keys.begin(), keys.end(), [&](const Key<S>& each) { return each.name == name; });
  if (key == keys.end()) throw std::invalid_argument("there is no setting " + in_quotes(name));
  const SettingValue now = key->get(settings);
  if (const auto* whole = std::get_if<std::int64_t>(&value); whole && std::holds_alternative<double>(now))
    value = double(*whole);
  if (value.index() != now.index() || !key->allowed(value))
    return in_quotes(name) + " is " + in_words(value) + ", not " + key->wanted;
  key->set(value, settings);
  return std::nullopt;
}

template <typename S>
std::vector<std::pair<std::string, SettingValue>> named(const std::vector<Key<S>>& keys, const S& settings) {
  std::vector<std::pair<std::string, SettingValue>> all;
  for (const Key<S>& key : keys) all.emplace_back(key.name, key.get(settings));
  return all;
}

}  // namespace insonate::keys
