#pragma once

#include <string>
#include <vector>

#include "sim/core/input_error.h"

namespace insonate {

/// A position in a text, counted from 1; line 0 if there is none.
struct SourcePlace {
  int line = 0;
  int column = 0;
};

/// Returns the place for an error sentence: "line 3, column 7"; empty if there is none.
std::string in_words(const SourcePlace& place);

/// A mistake in a file that a person wrote.
struct Mistake {
  SourcePlace place;
  std::string problem;  ///< what is wrong: "step 2: 'hold_s' is 90"
  std::string remedy;   ///< what to do, as an imperative: "give a number from 0.1 to 60"
};

/// Returns the mistakes in the order of the file, each once.
std::vector<Mistake> in_order_of_file(std::vector<Mistake> mistakes);

/// Returns the error that reports the mistakes of a file, in its order. For one mistake, what() is a sentence as
/// InputError describes it. For several it is a list: a line "FILE: 3 problems; correct them:" and a line for each of
/// the first 100. Needs at least one.
InputError input_error(const std::string& file, std::vector<Mistake> mistakes);

}  // namespace insonate
