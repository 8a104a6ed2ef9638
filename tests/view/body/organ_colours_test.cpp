#include "sim/view/body/organ_colours.h"

#include <catch2/catch.hpp>

using insonate::view::colour_of_organ;
using insonate::view::colours_of_organs;

TEST_CASE("structures are known by the words of their names, in the phantom's and in a segmenter's spelling") {
  for (const char* name : {"liver", "right_kidney_cortex", "kidney_left", "rib_left_7", "vertebrae_L1", "aorta",
                           "inferior_vena_cava", "portal_vein_and_splenic_vein", "gallbladder", "urinary_bladder"}) {
    INFO(name);
    CHECK(colour_of_organ(name).opacity > 0);
  }
  const auto artery = colour_of_organ("aorta").colour, vein = colour_of_organ("inferior_vena_cava").colour;
  CHECK(artery.r > artery.b);
  CHECK(vein.b > vein.r);
  const auto bile = colour_of_organ("gallbladder").colour;
  CHECK((bile.g > bile.r && bile.g > bile.b));
}

TEST_CASE("what lies in an organ comes before the organ") {
  CHECK(colour_of_organ("liver_vein").colour == colour_of_organ("vein").colour);
  CHECK(colour_of_organ("kidney_cyst_left").colour == colour_of_organ("cyst").colour);
  CHECK(colour_of_organ("pelvis").colour == colour_of_organ("sacrum").colour);
  CHECK(colour_of_organ("right_kidney_pelvis").colour != colour_of_organ("pelvis").colour);
  CHECK(colour_of_organ("aorta_wall").colour == colour_of_organ("aorta").colour);
}

TEST_CASE("what would hide the rest, and unknown names, are not drawn") {
  for (const char* name : {"skin", "subcutaneous_fat", "autochthon_left", "abdominal_wall", "", "deliverance"}) {
    INFO(name);
    CHECK(colour_of_organ(name).opacity == 0);
  }
}

TEST_CASE("colours go by label value, and more names than values are cut") {
  std::vector<std::string> names(300, "liver");
  names[0] = "";
  names[2] = "gallbladder";
  const auto colours = colours_of_organs(names);
  CHECK(colours[0].opacity == 0);
  CHECK(colours[2].colour == colour_of_organ("gallbladder").colour);
  CHECK(colours[255].opacity > 0);
}
