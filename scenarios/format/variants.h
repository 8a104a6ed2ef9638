#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/format/table_node.h"
#include "scenarios/format/table_reader.h"

namespace insonate {

/// `[[variant]]`: one of the ways in which the exam may come, drawn by the seed. What it says goes before what the file
/// says elsewhere.
struct Variant {
  std::string name;                                                  ///< name = "with a stone"; kept in the result
  std::string case_name;                                             ///< case = "...": instead of the file's
  SourcePlace case_place;                                            ///< meaningful where there is one
  std::vector<std::pair<std::string, std::string>> phantom_options;  ///< phantom = { gallstone = true }
  std::map<std::string, SourcePlace> option_places;                  ///< by option
  std::vector<std::pair<std::string, std::string>> words;            ///< words = { side = "right" }: see spell_out()
};

/// At most this many.
inline constexpr std::size_t kMostVariants = 32;

std::vector<Variant> read_variants(TableReader& scenario);

/// Which of `count` variants a seed draws.
std::size_t drawn(std::uint32_t seed, std::size_t count);

/// Puts the variant's words in place of ${side} in every text of the file's steps: titles, instructions, views,
/// structures, answers. A word that the variant does not have is a problem.
void spell_out(toml::table& root, const Variant& variant, std::vector<ScenarioProblem>& problems);

/// The options of a table like [phantom] as text, as the phantom's maker takes them, sorted by name.
/// @param places  gets where each stands; nullptr for nobody who wants to know
std::vector<std::pair<std::string, std::string>> read_options(TableReader& table,
                                                              std::map<std::string, SourcePlace>* places = nullptr);

}  // namespace insonate
