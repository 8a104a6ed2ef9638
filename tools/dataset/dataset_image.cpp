#include "tools/dataset/dataset_image.h"

#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>

#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "sim/files/digest.h"
#include "sim/model/settings_file.h"

namespace insonate {
namespace {

std::string settings_json(const Settings& settings) {
  nlohmann::ordered_json json;
  for (const auto& [name, value] : named_settings(settings))
    std::visit([&, &key = name](const auto& held) { json[key] = held; }, value);
  return json.dump();
}

template <typename T>
void add(Digest& digest, const std::vector<T>& values) {
  digest.add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

std::string digest_of(const DatasetImage& image) {
  Digest digest;
  for (const auto* pixels : {&image.grey, &image.truth.label, &image.truth.visible_label, &image.truth.reach})
    add(digest, pixels->pixels);
  add(digest, image.truth.skin_mm);
  digest.add({reinterpret_cast<const char*>(&image.patient_from_pixel), sizeof image.patient_from_pixel});
  digest.add(image.settings);
  digest.add(image.shot.probe.name);
  digest.add(image.shot.pose_source);
  return digest.text();
}

}  // namespace

DatasetImage with_truth(Shot&& shot, const Image<std::uint8_t>& grey, TruthMaker& maker) {
  const Settings& settings = shot.settings;
  maker.set_view(shot.probe, shot.depth_mm, settings);
  DatasetImage image;
  image.truth = maker.at(shot.patient_from_probe);
  for (Image<std::uint8_t>* map : {&image.truth.label, &image.truth.visible_label, &image.truth.reach})
    *map = mirrored(*map);
  image.grey = mirrored(grey);
  const ImageGeometry geometry = image_geometry(shot.probe, shot.depth_mm, grey.width, grey.height);
  glm::dmat4 as_drawn_from_shown(1.0);
  as_drawn_from_shown[0][0] = -1;
  as_drawn_from_shown[3][0] = grey.width - 1;
  image.patient_from_pixel = patient_from_pixel(geometry, shot.patient_from_probe) * as_drawn_from_shown;
  image.settings = settings_json(settings);
  image.shot = std::move(shot);
  image.digest = digest_of(image);
  return image;
}

}  // namespace insonate
