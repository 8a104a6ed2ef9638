#include "scenarios/format/variants.h"

#include <algorithm>

#include "sim/core/hash.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

/// Makes this use of the seed independent of any other use.
constexpr std::uint32_t kVariantDraw = 0x76617269u;

/// Returns a text with its ${words} replaced.
std::string spelt(const std::string& text, const SourcePlace& place, const Variant& variant, const TomlTable& root) {
  std::string out;
  std::size_t at = 0;
  for (;;) {
    const std::size_t begin = text.find("${", at);
    const std::size_t end = begin == std::string::npos ? begin : text.find('}', begin);
    if (end == std::string::npos) return out + text.substr(at);
    out += text.substr(at, begin - at);
    const std::string word = text.substr(begin + 2, end - begin - 2);
    std::vector<std::string> known;
    for (const auto& [name, value] : variant.words) {
      known.push_back(name);
      if (name == word) out += value;
    }
    if (std::find(known.begin(), known.end(), word) == known.end())
      root.report_at(place, "the text has '${" + word + "}', but the variant '" + variant.name + "' has no such word",
                     known.empty() ? "add it to the variant's words" : suggest(word, known));
    at = end + 1;
  }
}

}  // namespace

std::vector<Variant> read_variants(const TomlTable& scenario) {
  std::vector<Variant> variants;
  for (const TomlTable& table : scenario.tables("variant", kMaxVariants)) {
    Variant variant;
    variant.name = table.text("name");
    variant.case_name = table.text("case", "");
    variant.case_place = table.place("case");
    if (table.has("phantom")) variant.phantom_options = read_options(table.table("phantom"), &variant.option_places);
    if (table.has("words")) variant.words = read_options(table.table("words"));
    const bool taken =
        std::any_of(variants.begin(), variants.end(), [&](const Variant& v) { return v.name == variant.name; });
    if (taken) table.report("name", "the name " + in_quotes(variant.name) + " is taken", "give it another");
    variants.push_back(std::move(variant));
  }
  return variants;
}

std::size_t selected_variant(std::uint32_t seed, std::size_t count) {
  return count > 0 ? hash(seed, kVariantDraw) % count : 0;
}

void spell_out(TomlDocument& scenario, const Variant& variant) {
  scenario.replace_texts("step", [&](const std::string& text, const SourcePlace& place) {
    return spelt(text, place, variant, scenario.root());
  });
}

std::vector<std::pair<std::string, std::string>> read_options(const TomlTable& table,
                                                              std::map<std::string, SourcePlace>* places) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const std::string& option : table.keys()) {
    if (places) (*places)[option] = table.key_place(option);
    switch (table.kind(option)) {
      case TomlKind::text:
        options.emplace_back(option, table.text(option, ""));
        break;
      case TomlKind::boolean:
        options.emplace_back(option, table.boolean(option) ? "true" : "false");
        break;
      case TomlKind::number:
        options.emplace_back(option, exact_text(table.number(option)));
        break;
      default:
        table.report(option, in_quotes(option) + " is not a single value", "write true, false, a number or a text");
    }
  }
  std::sort(options.begin(), options.end());
  return options;
}

}  // namespace insonate
