// Recomputes how brightly each voxel scatters, from its Hounsfield units and those around it.

#include "tests/tools/render/recomputation.h"

namespace outsider {
namespace {

class Echogenicity {
public:
  explicit Echogenicity(const StageFolder& stages)
      : hu_(stages.hounsfield),
        labels_(stages.labels),
        about_(stages.description),
        constant_(about_.at("echogenicity")) {
    for (std::size_t v = 0; v < labels_.size(); ++v) {
      mean_[labels_[v]] += hu_.voxels[v];
      ++count_[labels_[v]];
    }
    for (std::size_t label = 0; label < mean_.size(); ++label) mean_[label] /= std::max(count_[label], 1.0);
    for (std::size_t a = 0; a < 3; ++a) {
      near_[a] = in_voxels("neighbour_mm", a);
      reach_[a] = in_voxels("edge_reach_mm", a);
    }
    for (const auto& knot : about_.at("tissues")) {
      knots_.emplace_back(knot.at("hu").get<double>(), knot.at("echogenicity_db").get<double>());
      const auto& air = about_.at("tissues").front();
      like_air_ = like_air_ && knot.at("impedance_mrayl") == air.at("impedance_mrayl") &&
                  knot.at("absorption_db_cm_mhz") == air.at("absorption_db_cm_mhz");
      if (like_air_) densest_air_ = std::min(knot.at("hu").get<int>(), constant_.at("most_air_hu").get<int>());
    }
  }

  /// Returns the echogenicity in hundredths of a dB.
  double at(const std::array<int, 3>& i) const {
    if (!labels_.empty()) {
      const int label = labels_[std::size_t((i[2] * hu_.size[1] + i[1]) * hu_.size[0] + i[0])];
      const auto& tissues = about_.at("tissue_of_label");
      if (const auto found = tissues.find(std::to_string(label)); found != tissues.end()) {
        const auto& tissue = about_.at("labelled_tissues").at(found->get<std::string>());
        const double db = tissue.at("echogenicity_db").get<double>() +
                          texture_db(hu_.voxel(i[0], i[1], i[2]) - mean_[std::size_t(label)]);
        return 100 * std::clamp(db, constant_.at("least_db").get<double>(), constant_.at("most_db").get<double>());
      }
    }
    if (amid_air(i)) return 100 * constant_.at("least_db").get<double>();
    const int hu = hu_.voxel(i[0], i[1], i[2]), density = local_density(i, hu);
    double echo = tabled(density) + std::round(100 * texture_db(hu - density));
    for (std::size_t a = 0; a < 3; ++a) {
      std::array<int, 3> before = i, after = i;
      before[a] -= reach_[a];
      after[a] += reach_[a];
      if (before[a] < 0 || after[a] >= hu_.size[a]) continue;
      const int one = hu_.voxel(before[0], before[1], before[2]), other = hu_.voxel(after[0], after[1], after[2]);
      const int margin = constant_.at("edge_margin_hu");
      if (hu - std::min(one, other) >= margin && std::max(one, other) - hu >= margin)
        echo = std::max({echo, tabled(one), tabled(other)});
    }
    return echo;
  }

private:
  int in_voxels(const char* length, std::size_t axis) const {
    return std::max(1, int(std::lround(constant_.at(length).get<double>() / outsider::length(hu_.step[axis]))));
  }

  bool amid_air(const std::array<int, 3>& i) const {
    for (int dk = -1; dk <= 1; ++dk)
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) {
          const std::array<int, 3> at = {i[0] + di, i[1] + dj, i[2] + dk};
          bool in_grid = true;
          for (std::size_t a = 0; a < 3; ++a) in_grid = in_grid && at[a] >= 0 && at[a] < hu_.size[a];
          if (in_grid && hu_.voxel(at[0], at[1], at[2]) > densest_air_) return false;
        }
    return true;
  }

  int local_density(const std::array<int, 3>& i, int hu) const {
    double sum = 0, count = 0;
    for (int dk = -1; dk <= 1; ++dk)
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) {
          const int there = hu_.voxel(std::clamp(i[0] + di * near_[0], 0, hu_.size[0] - 1),
                                      std::clamp(i[1] + dj * near_[1], 0, hu_.size[1] - 1),
                                      std::clamp(i[2] + dk * near_[2], 0, hu_.size[2] - 1));
          if (std::abs(there - hu) > alike_) continue;
          sum += there;
          ++count;
        }
    return int(std::lround(sum / count));
  }

  double tabled(int hu) const {
    double db = knots_.back().second;
    if (hu <= knots_.front().first) db = knots_.front().second;
    for (std::size_t k = 1; k < knots_.size(); ++k)
      if (hu > knots_[k - 1].first && hu <= knots_[k].first)
        db = knots_[k - 1].second + (hu - knots_[k - 1].first) / (knots_[k].first - knots_[k - 1].first) *
                                        (knots_[k].second - knots_[k - 1].second);
    return std::round(100 * db);
  }

  double texture_db(double above) const {
    const double rim = constant_.at("rim_hu"), full = constant_.at("texture_hu");
    const double fade = std::clamp((rim - std::abs(above)) / (rim - full), 0.0, 1.0);
    return constant_.at("texture_db_per_hu").get<double>() * above * fade;
  }

  const ShortVolume& hu_;
  const std::vector<std::uint8_t>& labels_;
  const nlohmann::json &about_, &constant_;
  const int alike_ = constant_.at("alike_hu");
  bool like_air_ = true;
  int densest_air_ = -32768;
  std::array<double, 256> mean_{}, count_{};  // of each label: mean HU and number of voxels
  std::array<int, 3> near_{}, reach_{};
  std::vector<std::pair<double, double>> knots_;
};

}  // namespace

std::map<std::string, double> volume_misfits(const StageFolder& stages) {
  const Echogenicity echogenicity(stages);
  std::map<std::string, double> worst;
  const ShortVolume &hu = stages.hounsfield, &written = stages.echogenicity;
  const auto& volume = stages.description.at("volume");
  for (std::size_t a = 0; a < 3; ++a) {
    const bool same = hu.size == written.size && volume.at("size").at(a) == hu.size[a];
    const Vec3 off = volume.at("spacing_mm").at(a).get<double>() * vec3(volume.at("axes").at(a)) - hu.step[a];
    worst["geometry"] = std::max({worst["geometry"], same ? 0 : HUGE_VAL, length(off) / 1e-9,
                                  length(vec3(volume.at("origin_mm")) - hu.origin) / 1e-9});
  }
  if (worst["geometry"] > 1) return worst;
  double& misfit = worst["volume_echogenicity"];
  for (int k = 0; k < hu.size[2]; ++k)
    for (int j = 0; j < hu.size[1]; ++j)
      for (int i = 0; i < hu.size[0]; ++i)  // one off where a half is rounded
        misfit = std::max(misfit, std::abs(echogenicity.at({i, j, k}) - written.voxel(i, j, k)) / 1.5);
  return worst;
}

}  // namespace outsider
