#include "sim/view/body/organ_colours.h"

#include <algorithm>
#include <initializer_list>

namespace insonate::view {
namespace {

struct Known {
  std::initializer_list<std::string_view> words;  // any of them, as a whole word of the name
  OrganColour look;
};

constexpr OrganColour kNotDrawn{};

// Searched in this order: a structure within an organ comes before the organ ("liver_vein"). The colours are the muted
// ones of anatomical atlases: arteries red, veins blue, bile green, bone ivory.
const Known kKnown[] = {
    // These have no shape of their own, or would hide everything else.
    {{"skin", "fat", "muscle", "muscles", "subcutaneous", "body", "air", "iliopsoas", "gluteus", "autochthon", "fascia",
      "diaphragm", "abdominal_wall"},
     kNotDrawn},
    {{"stone", "gallstone", "calculus"}, {{0.95f, 0.92f, 0.75f}, 0.9f}},
    {{"fluid", "ascites"}, {{0.35f, 0.65f, 0.85f}, 0.35f}},
    {{"cyst"}, {{0.45f, 0.68f, 0.80f}, 0.6f}},
    {{"aorta", "artery", "arteries", "aneurysm"}, {{0.74f, 0.24f, 0.20f}, 0.9f}},
    {{"cava", "vein", "veins", "venous", "portal", "hepatic"}, {{0.30f, 0.38f, 0.60f}, 0.9f}},
    {{"vessel", "vessels"}, {{0.46f, 0.32f, 0.52f}, 0.9f}},
    {{"gallbladder", "bile"}, {{0.38f, 0.54f, 0.30f}, 0.9f}},
    {{"liver"}, {{0.54f, 0.28f, 0.21f}, 0.8f}},
    {{"sinus", "kidney_pelvis", "renal_pelvis"}, {{0.82f, 0.70f, 0.46f}, 0.8f}},
    {{"medulla"}, {{0.40f, 0.15f, 0.14f}, 0.8f}},
    {{"kidney", "cortex"}, {{0.52f, 0.20f, 0.18f}, 0.8f}},
    {{"adrenal"}, {{0.76f, 0.60f, 0.34f}, 0.8f}},
    {{"spleen"}, {{0.44f, 0.21f, 0.29f}, 0.8f}},
    {{"pancreas"}, {{0.80f, 0.63f, 0.45f}, 0.8f}},
    {{"stomach", "oesophagus", "esophagus"}, {{0.74f, 0.54f, 0.49f}, 0.7f}},
    {{"bowel", "colon", "duodenum", "intestine", "ileum", "jejunum", "rectum"}, {{0.73f, 0.58f, 0.47f}, 0.7f}},
    {{"bladder", "urine"}, {{0.80f, 0.73f, 0.44f}, 0.7f}},
    {{"uterus", "prostate"}, {{0.72f, 0.48f, 0.45f}, 0.8f}},
    {{"heart"}, {{0.58f, 0.25f, 0.22f}, 0.8f}},
    {{"lung", "lungs"}, {{0.66f, 0.58f, 0.60f}, 0.15f}},
    {{"cord", "spinal_canal"}, {{0.90f, 0.85f, 0.60f}, 0.6f}},
    {{"cartilage", "cartilages", "disc", "discs"}, {{0.72f, 0.78f, 0.78f}, 0.7f}},
    {{"bone", "rib", "ribs", "vertebra", "vertebrae", "spine", "sacrum", "hip", "femur", "sternum", "costal", "marrow",
      "pelvis", "pelvic", "scapula", "clavicula", "humerus"},
     {{0.90f, 0.85f, 0.73f}, 0.9f}},
};

// Returns whether `name` holds `word` without letters next to it, which would make it another word. A phrase must match
// as written.
bool has_word(std::string_view name, std::string_view word) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (std::size_t at = name.find(word); at != std::string_view::npos; at = name.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_letter(name[at - 1])) && (end == name.size() || !is_letter(name[end]))) return true;
  }
  return false;
}

}  // namespace

OrganColour colour_of_organ(std::string_view name) {
  for (const Known& known : kKnown)
    if (std::any_of(known.words.begin(), known.words.end(), [&](auto word) { return has_word(name, word); }))
      return known.look;
  return kNotDrawn;
}

OrganColours colours_of_organs(const std::vector<std::string>& names) {
  OrganColours colours{};
  for (std::size_t value = 0; value < std::min(names.size(), colours.size()); ++value)
    colours[value] = colour_of_organ(names[value]);
  return colours;
}

}  // namespace insonate::view
