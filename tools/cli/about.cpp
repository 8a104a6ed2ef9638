#include "tools/cli/about.h"

#include "commit.h"

namespace insonate {

std::vector<AboutLine> about_this_build() {
  return {
      {"Version", INSONATE_VERSION}, {"Commit", INSONATE_COMMIT}, {"Build", INSONATE_BUILD}, {"Licence", "Apache-2.0"}};
}

std::string version_text(const std::string& program, const std::vector<AboutLine>& more) {
  std::vector<AboutLine> lines = about_this_build();
  lines.insert(lines.end(), more.begin(), more.end());
  std::string text = program + " (Insonate) " INSONATE_VERSION "\n";
  for (const AboutLine& line : lines) text += line.name + ": " + line.text + "\n";
  return text + kNoMedicalDevice;
}

}  // namespace insonate
