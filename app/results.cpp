#include "app/results.h"

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/report.h"
#include "scenarios/result_json.h"
#include "sim/core/files.h"

namespace insonate {
namespace {

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t j = 0; j < 3; ++j)
      group = group << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0u);
    for (std::size_t j = 0; j < 4; ++j) text += i + j <= bytes.size() ? kDigits[group >> (18 - 6 * j) & 63u] : '=';
  }
  return text;
}

}  // namespace

ResultFiles write_results(const std::filesystem::path& folder, const Session& session,
                          const std::optional<Image<Rgba8>>& best_frame) {
  if (!session.result() || !session.runner()) throw std::logic_error("the exam is not finished");
  ResultFiles files{folder / "report.html", folder / "score.json"};
  std::vector<ReportPicture> pictures;
  if (best_frame) {
    const std::filesystem::path png = folder / "ultrasound.png";
    write_png(png, *best_frame);
    pictures.push_back({"The picture while the view was held best", "data:image/png;base64," + base64(read_file(png))});
  }
  write_file(files.report, report_html(*session.result(), session.runner()->trace(), pictures));
  write_file(files.score, to_json(*session.result()));
  return files;
}

}  // namespace insonate
