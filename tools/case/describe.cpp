// insonate-case inspect.

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "sim/volume/case.h"
#include "sim/volume/ct_reader.h"
#include "tools/case/commands.h"

namespace insonate {
namespace {

using Json = nlohmann::ordered_json;

Json as_json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

struct Orientation {
  std::string letters;   ///< directions of i, j and k
  std::string in_words;  ///< "i to the left, j to the back, k to the head"
  double oblique_deg;    ///< largest angle between an axis and the nearest axis of the body
};

Orientation orientation_of(const Grid& grid) {
  static const char letters[2][3] = {{'L', 'P', 'S'}, {'R', 'A', 'I'}};
  static const char* const words[2][3] = {{"left", "back", "head"}, {"right", "front", "feet"}};
  Orientation found{"", "", 0};
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 d = grid.direction[axis];
    int most = 0;
    for (int r = 1; r < 3; ++r)
      if (std::abs(d[r]) > std::abs(d[most])) most = r;
    const bool against = d[most] < 0;
    found.letters += letters[against][most];
    found.in_words += (axis ? ", " : "") + std::string(1, "ijk"[axis]) + " to the " + words[against][most];
    const double aside = std::abs(d[(most + 1) % 3]) + std::abs(d[(most + 2) % 3]);
    if (aside > 1e-6)
      found.oblique_deg = std::max(found.oblique_deg, glm::degrees(std::acos(std::min(1.0, std::abs(d[most])))));
  }
  return found;
}

Json describe_densities(const std::vector<std::int16_t>& voxels) {
  std::vector<std::size_t> histogram(1u << 16);
  for (const std::int16_t hu : voxels) ++histogram[std::size_t(hu + 32768)];
  const auto percentile = [&](double share) {
    // The smallest value that at least this share of the voxels does not exceed.
    const auto wanted = std::max<std::size_t>(1, std::size_t(std::ceil(share * double(voxels.size()))));
    std::size_t seen = 0, value = 0;
    while ((seen += histogram[value]) < wanted) ++value;
    return int(value) - 32768;
  };
  Json percentiles;
  for (const int percent : {1, 5, 25, 50, 75, 95, 99})
    percentiles[std::to_string(percent)] = percentile(percent / 100.0);
  return {{"least", percentile(0)}, {"most", percentile(1)}, {"percentiles", percentiles}};
}

Json describe_grid(const Grid& grid) {
  const Orientation orientation = orientation_of(grid);
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r)
    // Adding 0 turns -0 into 0.
    rows.push_back({grid.direction[0][r] + 0.0, grid.direction[1][r] + 0.0, grid.direction[2][r] + 0.0});
  return {{"size", {grid.size.x, grid.size.y, grid.size.z}},
          {"spacing_mm", as_json(grid.spacing)},
          {"origin_mm", as_json(grid.origin)},
          {"direction", rows},
          {"orientation", orientation.letters},
          {"axes", orientation.in_words},
          {"oblique_deg", orientation.oblique_deg}};
}

Json describe_labels(const Case& subject) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t value : subject.labels.voxels) ++counts[value];
  const glm::dvec3 spacing = subject.ct.grid.spacing;
  const double voxel_ml = spacing.x * spacing.y * spacing.z / 1000;
  Json labels = Json::array();
  for (const Label& label : subject.label_table)
    labels.push_back({{"value", label.value},
                      {"name", label.name},
                      {"tissue", label.tissue},
                      {"voxels", counts[label.value]},
                      {"volume_ml", double(counts[label.value]) * voxel_ml}});
  return labels;
}

Json describe_views(const Case& subject) {
  Json views = Json::array();
  for (const ReferenceView& view : subject.views) {
    const glm::dmat4 m = view.patient_from_probe.matrix();
    Json matrix = Json::array();
    for (int i = 0; i < 16; ++i) matrix.push_back(m[i % 4][i / 4]);
    views.push_back({{"name", view.name},
                     {"title", view.title},
                     {"probe", view.probe},
                     {"depth_mm", view.depth_mm},
                     {"landmarks", view.landmarks},
                     {"targets", view.targets},
                     {"patient_from_probe", matrix}});
  }
  return views;
}

Json describe(const std::filesystem::path& path) {
  Json about{{"path", path.string()}};
  std::error_code error;
  Case subject;
  if (std::filesystem::exists(path / "case.toml", error)) {
    subject = read_case(path);
    about["format"] = "case";
    about["name"] = subject.name;
  } else {
    CtSource source;
    subject.ct = read_ct(path, &source);
    about["format"] = source.format;
    about["stored_as"] = source.stored_as;
    about["clamped_voxels"] = source.clamped;
    about["other_series"] = source.other_series;
  }
  about.update(describe_grid(subject.ct.grid));
  about["hu"] = describe_densities(subject.ct.voxels);
  if (about["format"] == "case") {
    about["labels"] = describe_labels(subject);
    about["landmarks"] = Json::array();
    for (const Landmark& landmark : subject.landmarks)
      about["landmarks"].push_back({{"name", landmark.name}, {"position_mm", as_json(landmark.position)}});
    about["views"] = describe_views(subject);
  }
  return about;
}

double number(const Json& value) {
  return value.get<double>();
}

std::string joined(const Json& texts) {
  std::string all;
  for (const Json& text : texts) all += (all.empty() ? "" : ", ") + text.get<std::string>();
  return all.empty() ? "none" : all;
}

void print_for_people(const Json& about) {
  const auto text = [&](const char* key) { return about.at(key).get<std::string>(); };
  std::printf("%s\n", text("path").c_str());
  if (about.contains("name")) std::printf("  case          %s\n", text("name").c_str());
  if (about.contains("stored_as"))
    std::printf("  format        %s, stored as %s\n", text("format").c_str(), text("stored_as").c_str());
  const Json &size = about["size"], &spacing = about["spacing_mm"], &origin = about["origin_mm"];
  std::printf("  size          %d x %d x %d voxels\n", size[0].get<int>(), size[1].get<int>(), size[2].get<int>());
  std::printf("  spacing       %.4g x %.4g x %.4g mm\n", number(spacing[0]), number(spacing[1]), number(spacing[2]));
  std::printf("  origin        %.6g, %.6g, %.6g mm (LPS)\n", number(origin[0]), number(origin[1]), number(origin[2]));
  std::printf("  orientation   %s: %s", text("orientation").c_str(), text("axes").c_str());
  if (const double oblique = number(about["oblique_deg"]); oblique > 0.01)
    std::printf("; oblique by %.1f degrees", oblique);
  std::printf("\n");
  for (int r = 0; r < 3; ++r) {
    const Json& row = about["direction"][std::size_t(r)];
    std::printf("  %s% .6f % .6f % .6f\n", r == 0 ? "direction    " : "             ", number(row[0]), number(row[1]),
                number(row[2]));
  }
  const Json &hu = about["hu"], &percentiles = hu["percentiles"];
  std::printf("  HU            %d to %d; percentiles", hu["least"].get<int>(), hu["most"].get<int>());
  for (const auto& [percent, value] : percentiles.items()) std::printf("  %s%%: %d", percent.c_str(), value.get<int>());
  std::printf("\n");
  if (about.contains("clamped_voxels") && about["clamped_voxels"].get<std::size_t>() > 0)
    std::printf("  clamped       %zu voxels outside -1024 to 32767\n", about["clamped_voxels"].get<std::size_t>());
  if (about.contains("other_series"))
    for (const Json& series : about["other_series"])
      std::printf("  not taken     %s\n", series.get<std::string>().c_str());
  if (about["format"] != "case") return;

  std::printf("  labels        %zu\n", about["labels"].size());
  for (const Json& label : about["labels"])
    std::printf("    %3d  %-26s %-16s %10.1f ml\n", label["value"].get<int>(), label["name"].get<std::string>().c_str(),
                label["tissue"].get<std::string>().c_str(), number(label["volume_ml"]));
  std::printf("  landmarks     %zu\n", about["landmarks"].size());
  for (const Json& landmark : about["landmarks"]) {
    const Json& p = landmark["position_mm"];
    std::printf("         %-26s %.1f, %.1f, %.1f mm\n", landmark["name"].get<std::string>().c_str(), number(p[0]),
                number(p[1]), number(p[2]));
  }
  std::printf("  views         %zu\n", about["views"].size());
  for (const Json& view : about["views"]) {
    std::printf("         %-26s %s\n", view["name"].get<std::string>().c_str(),
                view["title"].get<std::string>().c_str());
    std::printf("         %-26s %s probe, %.0f mm deep; landmarks: %s; targets: %s\n", "",
                view["probe"].get<std::string>().c_str(), number(view["depth_mm"]), joined(view["landmarks"]).c_str(),
                joined(view["targets"]).c_str());
  }
}

}  // namespace

void inspect(const std::filesystem::path& path, bool json) {
  const Json about = describe(path);
  if (json)
    std::printf("%s\n", about.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  else
    print_for_people(about);
}

}  // namespace insonate
