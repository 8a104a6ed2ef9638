#include "scenarios/format/variants.h"

#include <algorithm>

#include "sim/core/hash.h"
#include "sim/core/suggest.h"

namespace insonate {
namespace {

/// Makes this use of the seed independent of any other use.
constexpr std::uint32_t kVariantDraw = 0x76617269u;

class Speller {
public:
  Speller(const Variant& variant, std::vector<ScenarioProblem>& problems) : variant_(variant), problems_(problems) {
    for (const auto& [word, value] : variant.words) known_.push_back(word);
  }

  void visit(toml::node& node) {
    if (toml::table* table = node.as_table())
      for (auto&& [key, value] : *table) visit(value);
    else if (toml::array* array = node.as_array())
      for (toml::node& value : *array) visit(value);
    else if (node.is_string())
      node.as_string()->get() = spelt(node.as_string()->get(), node.source());
  }

private:
  std::string spelt(const std::string& text, const toml::source_region& source) {
    std::string out;
    std::size_t at = 0;
    for (;;) {
      const std::size_t begin = text.find("${", at);
      const std::size_t end = begin == std::string::npos ? begin : text.find('}', begin);
      if (end == std::string::npos) return out + text.substr(at);
      out += text.substr(at, begin - at);
      const std::string word = text.substr(begin + 2, end - begin - 2);
      const auto found = std::find_if(variant_.words.begin(), variant_.words.end(),
                                      [&](const auto& one) { return one.first == word; });
      if (found != variant_.words.end())
        out += found->second;
      else
        problems_.push_back({{int(source.begin.line), int(source.begin.column)},
                             "the text has '${" + word + "}', but the variant '" + variant_.name + "' has no such word",
                             known_.empty() ? "add it to the variant's words" : suggest(word, known_)});
      at = end + 1;
    }
  }

  const Variant& variant_;
  std::vector<ScenarioProblem>& problems_;
  std::vector<std::string> known_;
};

}  // namespace

std::vector<Variant> read_variants(TableReader& scenario) {
  std::vector<Variant> variants;
  for (const auto& table : scenario.tables("variant", kMostVariants, "variant ", "")) {
    Variant variant;
    variant.name = table->text("name");
    variant.case_name = table->text("case", false);
    variant.case_place = table->place("case");
    if (const auto options = table->table("phantom", false, "the phantom of " + table->where()))
      variant.phantom_options = read_options(*options, &variant.option_places);
    if (const auto words = table->table("words", false, "the words of " + table->where()))
      variant.words = read_options(*words);
    const bool taken =
        std::any_of(variants.begin(), variants.end(), [&](const Variant& v) { return v.name == variant.name; });
    if (taken) table->problem(table->place("name"), "has a name that is taken", "give it another");
    variants.push_back(std::move(variant));
  }
  return variants;
}

std::size_t drawn(std::uint32_t seed, std::size_t count) {
  return count > 0 ? hash(seed, kVariantDraw) % count : 0;
}

void spell_out(toml::table& root, const Variant& variant, std::vector<ScenarioProblem>& problems) {
  Speller speller(variant, problems);
  if (toml::node* steps = root.get("step")) speller.visit(*steps);
}

std::vector<std::pair<std::string, std::string>> read_options(TableReader& table,
                                                              std::map<std::string, SourcePlace>* places) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const TableReader::Entry& entry : table.entries()) {
    if (places) (*places)[entry.key] = entry.key_place;
    if (entry.text)
      options.emplace_back(entry.key, *entry.text);
    else if (entry.yes)
      options.emplace_back(entry.key, *entry.yes ? "true" : "false");
    else if (entry.number)
      options.emplace_back(entry.key, plain(*entry.number));
    else
      table.problem(entry.value_place, "has an option '" + entry.key + "' that is no single value",
                    "write true, false, a number or a text");
  }
  std::sort(options.begin(), options.end());
  return options;
}

}  // namespace insonate
