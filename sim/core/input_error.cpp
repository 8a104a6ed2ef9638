#include "sim/core/input_error.h"

namespace insonate {
namespace {

std::string sentence(const std::string& file, const std::string& place, const std::string& problem,
                     const std::string& remedy) {
  std::string text = file + ": ";
  if (!place.empty()) text += place + ": ";
  text += problem + "; " + remedy;
  return text.back() == '?' ? text : text + ".";
}

}  // namespace

InputError::InputError(const std::string& file, const std::string& place, const std::string& problem,
                       const std::string& remedy)
    : std::runtime_error(sentence(file, place, problem, remedy)) {}

}  // namespace insonate
