#include "scenarios/cases/structures.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <utility>

namespace insonate {
namespace {

// Names in the order of their values, from 1, in TotalSegmentator's class map (github.com/wasserth/TotalSegmentator,
// totalsegmentator/map_to_binary.py, "total_v1" and "total"). A name with A..B stands for a series of names.
constexpr std::string_view kTotalV1 =
    "spleen kidney_right kidney_left gallbladder liver stomach aorta inferior_vena_cava portal_vein_and_splenic_vein "
    "pancreas adrenal_gland_right adrenal_gland_left lung_upper_lobe_left lung_lower_lobe_left lung_upper_lobe_right "
    "lung_middle_lobe_right lung_lower_lobe_right vertebrae_L5..1 vertebrae_T12..1 vertebrae_C7..1 esophagus trachea "
    "heart_myocardium heart_atrium_left heart_ventricle_left heart_atrium_right heart_ventricle_right "
    "pulmonary_artery brain iliac_artery_left iliac_artery_right iliac_vena_left iliac_vena_right small_bowel duodenum "
    "colon rib_left_1..12 rib_right_1..12 humerus_left humerus_right scapula_left scapula_right clavicula_left "
    "clavicula_right femur_left femur_right hip_left hip_right sacrum face gluteus_maximus_left gluteus_maximus_right "
    "gluteus_medius_left gluteus_medius_right gluteus_minimus_left gluteus_minimus_right autochthon_left "
    "autochthon_right iliopsoas_left iliopsoas_right urinary_bladder";
constexpr std::string_view kTotal =
    "spleen kidney_right kidney_left gallbladder liver stomach pancreas adrenal_gland_right adrenal_gland_left "
    "lung_upper_lobe_left lung_lower_lobe_left lung_upper_lobe_right lung_middle_lobe_right lung_lower_lobe_right "
    "esophagus trachea thyroid_gland small_bowel duodenum colon urinary_bladder prostate kidney_cyst_left "
    "kidney_cyst_right sacrum vertebrae_S1 vertebrae_L5..1 vertebrae_T12..1 vertebrae_C7..1 heart aorta pulmonary_vein "
    "brachiocephalic_trunk subclavian_artery_right subclavian_artery_left common_carotid_artery_right "
    "common_carotid_artery_left brachiocephalic_vein_left brachiocephalic_vein_right atrial_appendage_left "
    "superior_vena_cava inferior_vena_cava portal_vein_and_splenic_vein iliac_artery_left iliac_artery_right "
    "iliac_vena_left iliac_vena_right humerus_left humerus_right scapula_left scapula_right clavicula_left "
    "clavicula_right femur_left femur_right hip_left hip_right spinal_cord gluteus_maximus_left gluteus_maximus_right "
    "gluteus_medius_left gluteus_medius_right gluteus_minimus_left gluteus_minimus_right autochthon_left "
    "autochthon_right iliopsoas_left iliopsoas_right brain skull rib_left_1..12 rib_right_1..12 sternum "
    "costal_cartilages";

LabelNames numbered(std::string_view list) {
  LabelNames names;
  std::istringstream words{std::string(list)};
  for (std::string word; words >> word;) {
    const auto dots = word.find("..");
    if (dots == std::string::npos) {
      names[int(names.size()) + 1] = word;
      continue;
    }
    const auto digits = word.find_last_not_of("0123456789", dots - 1) + 1;
    const int last = std::stoi(word.substr(dots + 2));
    int n = std::stoi(word.substr(digits, dots - digits));
    for (const int step = n < last ? 1 : -1; n != last + step; n += step)
      names[int(names.size()) + 1] = word.substr(0, digits) + std::to_string(n);
  }
  return names;
}

// Tissue by a structure's name or its beginning; the first match counts. A kidney is one label including its sinus, and
// most of it is cortex. Hollow organs are assumed to be filled as in a fasting patient.
constexpr std::array kTissues =
    std::to_array<std::pair<std::string_view, std::string_view>>({{"spleen", "spleen"},
                                                                  {"kidney", "kidney_cortex"},
                                                                  {"gallbladder", "bile"},
                                                                  {"liver", "liver"},
                                                                  {"stomach", "stomach"},
                                                                  {"pancreas", "pancreas"},
                                                                  {"adrenal_gland", "soft_tissue"},
                                                                  {"lung", "lung"},
                                                                  {"esophagus", "bowel"},
                                                                  {"trachea", "gas"},
                                                                  {"thyroid_gland", "soft_tissue"},
                                                                  {"small_bowel", "bowel"},
                                                                  {"duodenum", "bowel"},
                                                                  {"colon", "bowel"},
                                                                  {"urinary_bladder", "urine"},
                                                                  {"prostate", "soft_tissue"},
                                                                  {"sacrum", "bone"},
                                                                  {"vertebrae", "bone"},
                                                                  {"rib_", "bone"},
                                                                  {"sternum", "bone"},
                                                                  {"costal_cartilages", "cartilage"},
                                                                  {"humerus", "bone"},
                                                                  {"scapula", "bone"},
                                                                  {"clavicula", "bone"},
                                                                  {"femur", "bone"},
                                                                  {"hip", "bone"},
                                                                  {"skull", "bone"},
                                                                  {"heart_atrium", "blood"},
                                                                  {"heart_ventricle", "blood"},
                                                                  {"heart", "muscle"},
                                                                  {"atrial_appendage", "blood"},
                                                                  {"aorta", "blood"},
                                                                  {"pulmonary_vein", "blood"},
                                                                  {"pulmonary_artery", "blood"},
                                                                  {"brachiocephalic", "blood"},
                                                                  {"subclavian_artery", "blood"},
                                                                  {"common_carotid_artery", "blood"},
                                                                  {"superior_vena_cava", "blood"},
                                                                  {"inferior_vena_cava", "blood"},
                                                                  {"portal_vein", "blood"},
                                                                  {"iliac_artery", "blood"},
                                                                  {"iliac_vena", "blood"},
                                                                  {"gluteus", "muscle"},
                                                                  {"autochthon", "muscle"},
                                                                  {"iliopsoas", "muscle"},
                                                                  {"spinal_cord", "soft_tissue"},
                                                                  {"brain", "soft_tissue"},
                                                                  {"face", "soft_tissue"}});

// Findings in or beside an organ, by a part of the name: a cyst of the liver is drawn as a cyst.
constexpr std::array kFindings = std::to_array<std::pair<std::string_view, std::string_view>>({{"cyst", "cyst"},
                                                                                               {"stone", "stone"},
                                                                                               {"calcul", "stone"},
                                                                                               {"lith", "stone"},
                                                                                               {"fluid", "fluid"},
                                                                                               {"ascites", "fluid"},
                                                                                               {"effusion", "fluid"},
                                                                                               {"haemato", "blood"},
                                                                                               {"hemato", "blood"}});

}  // namespace

std::optional<std::string> finding_tissue(std::string_view structure) {
  for (const auto& [part, tissue] : kFindings)
    if (structure.find(part) != std::string_view::npos) return std::string(tissue);
  return std::nullopt;
}

std::optional<LabelNames> standard_label_table(std::string_view name) {
  if (name == "total") return numbered(kTotal);
  if (name == "total_v1") return numbered(kTotalV1);
  return std::nullopt;
}

std::vector<std::string> standard_label_tables() {
  return {"total", "total_v1"};
}

std::optional<std::string> tissue_of_structure(std::string_view structure) {
  if (const auto finding = finding_tissue(structure)) return finding;
  for (const auto& [beginning, tissue] : kTissues)
    if (structure.starts_with(beginning)) return std::string(tissue);
  return std::nullopt;
}

std::string title_of_structure(std::string_view structure) {
  std::string title;
  for (const std::string_view side : {"right", "left"})
    if (structure.size() > side.size() && structure.ends_with(side) &&
        structure[structure.size() - side.size() - 1] == '_') {
      title = std::string(side) + " ";
      structure.remove_suffix(side.size() + 1);
    }
  title += structure;
  std::replace(title.begin(), title.end(), '_', ' ');
  title[0] = char(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

}  // namespace insonate
