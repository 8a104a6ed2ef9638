#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim/files/toml_table.h"

namespace insonate {

/// `[[variant]]`: one version of the exam, selected by the seed. Its values override those of the file.
struct Variant {
  std::string name;                                                  ///< name = "with a stone"; stored in the result
  std::string case_name;                                             ///< case = "...": replaces the file's case
  SourcePlace case_place;                                            ///< meaningful only with a case
  std::vector<std::pair<std::string, std::string>> phantom_options;  ///< phantom = { gallstone = true }
  std::map<std::string, SourcePlace> option_places;                  ///< by option
  std::vector<std::pair<std::string, std::string>> words;            ///< words = { side = "right" }: see spell_out()
};

inline constexpr std::size_t kMaxVariants = 32;

/// Reads the [[variant]] tables of a scenario, at most kMaxVariants.
std::vector<Variant> read_variants(const TomlTable& scenario);

/// Returns the index of the variant that a seed selects among `count`; 0 if there is none.
std::size_t selected_variant(std::uint32_t seed, std::size_t count);

/// Replaces ${side} by the variant's word `side` in every text of the file's steps: titles, instructions, views,
/// structures, answers. A word that the variant does not define is a mistake.
void spell_out(TomlDocument& scenario, const Variant& variant);

/// Returns the options of a table such as [phantom] as text, in the form that the phantom builder reads, sorted by
/// name.
/// @param places  receives the position of each option; may be nullptr
std::vector<std::pair<std::string, std::string>> read_options(const TomlTable& table,
                                                              std::map<std::string, SourcePlace>* places = nullptr);

}  // namespace insonate
