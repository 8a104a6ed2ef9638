#include "tools/dataset/setting_ranges.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "sim/core/suggest.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

constexpr const char* kShift = "tgc_shift_db";

/// Returns a setting's value as it is by default, which shows its kind.
SettingValue kind_of(const std::string& name) {
  static const auto all = named_settings(Settings{});
  for (const auto& [known, value] : all)
    if (known == name) return value;
  throw std::invalid_argument(name);
}

SettingValue of_number(double number, bool whole) {
  return whole ? SettingValue(std::in_place_type<std::int64_t>, std::int64_t(number))
               : SettingValue(std::in_place_type<double>, number);
}

/// Reads what one key holds. Returns nothing if it is of a kind that no setting takes, which is then reported.
SettingRange read_range_of(const TomlTable& table, const std::string& name) {
  SettingRange range;
  range.name = name;
  const SettingValue kind = kind_of(name);
  range.whole = std::holds_alternative<std::int64_t>(kind);
  if (const auto* numbers = std::get_if<std::vector<double>>(&kind)) {
    range.choices.emplace_back(table.numbers(name, numbers->size()));
  } else if (std::holds_alternative<bool>(kind)) {
    if (table.kind(name) == TomlKind::text && table.text(name, "") == kEither)
      for (const bool either : {true, false}) range.choices.emplace_back(either);
    else
      range.choices.emplace_back(table.boolean(name));
  } else if (std::holds_alternative<std::string>(kind)) {
    if (table.kind(name) == TomlKind::list)
      for (const std::string& text : table.texts(name, 1)) range.choices.emplace_back(text);
    else
      range.choices.emplace_back(table.text(name));
  } else if (table.kind(name) == TomlKind::list) {
    range.range = table.interval(name, {});
    if (range.range && range.whole &&
        (range.range->least != std::floor(range.range->least) || range.range->most != std::floor(range.range->most)))
      table.report(name, in_quotes(name) + " is not a range of whole numbers",
                   "write the least and the most without a point");
  } else {
    const double number = table.number(name);
    if (range.whole && number != std::floor(number))
      table.report(name, in_quotes(name) + " is not a whole number", "write one");
    else
      range.choices.push_back(of_number(number, range.whole));
  }
  return range;
}

/// Reports the values of a range that the setting does not take. Settings that must be odd are drawn among odd numbers.
void check_values(const TomlTable& table, SettingRange& range) {
  const auto why_not = [&](const SettingValue& value) {
    Settings scratch;
    return set_setting(scratch, range.name, value);
  };
  std::vector<SettingValue> ends = range.choices;
  if (range.range) {
    ends.clear();
    for (const double end : {range.range->least, range.range->most}) ends.push_back(of_number(end, range.whole));
    // Only odd numbers, if the number above the least one is refused and the next but one is not.
    if (range.whole && range.range->most - range.range->least >= 2 &&
        why_not(of_number(range.range->least + 1, true)) && !why_not(of_number(range.range->least + 2, true)))
      range.step = 2;
  }
  for (const SettingValue& value : ends)
    if (const auto why = why_not(value)) {
      table.report(range.name, *why, "correct it");
      return;
    }
}

}  // namespace

void read_setting_ranges(const TomlTable& table, Study& study) {
  if (table.has(kShift)) study.tgc_shift_db = table.interval(kShift, {-60, 60}).value_or(study.tgc_shift_db);
  for (const auto& [name, value] : named_settings(Settings{})) {
    if (!table.has(name)) continue;
    if (name == "frequency_mhz") {
      table.report(name, "the frequency belongs to the probe", "write 'frequency_mhz' below [[probe]]");
      continue;
    }
    SettingRange range = read_range_of(table, name);
    const bool fixed = name == "image_width" || name == "image_height";
    if (fixed && range.range)
      table.report(name, "all images of a study have the same size", "write one number for " + in_quotes(name));
    check_values(table, range);
    study.settings.push_back(std::move(range));
  }
}

bool may_have_waves(const Study& study) {
  for (const SettingRange& range : study.settings)
    if (range.name == "waves")
      return std::any_of(range.choices.begin(), range.choices.end(),
                         [](const SettingValue& value) { return std::get<bool>(value); });
  return true;
}

Settings draw_settings(const Study& study, const Draws& draws, double frequency_mhz, double depth_mm,
                       std::uint32_t patient_seed) {
  Settings settings = trainer_settings(frequency_mhz, depth_mm);
  settings.image_width = settings.image_height = kUsualPictureSide;
  settings.speckle_seed = patient_seed;
  for (const SettingRange& range : study.settings) {
    SettingValue value;
    if (!range.range) {
      value = range.choices[draws.below(std::uint32_t(range.choices.size()), range.name)];
    } else if (range.whole) {
      const double steps = (range.range->most - range.range->least) / range.step + 1;
      const double drawn = draws.below(std::uint32_t(std::min(steps, 4294967295.0)), range.name);
      value = std::int64_t(range.range->least + range.step * drawn);
    } else {
      value = draws.within(*range.range, range.name);
    }
    if (const auto why = set_setting(settings, range.name, value)) throw std::logic_error(*why);
  }
  for (std::size_t i = 0; i < settings.tgc_db.size(); ++i) {
    const double shifted = settings.tgc_db[i] + draws.within(study.tgc_shift_db, kShift, std::uint32_t(i));
    settings.tgc_db[i] = std::clamp(shifted, -kMaxTimeGain_db, kMaxTimeGain_db);
  }
  return settings;
}

}  // namespace insonate
