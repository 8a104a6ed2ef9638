#include "app/registration/screen/registration_state.h"

#include <nlohmann/json.hpp>

#include "sim/files/files.h"

namespace insonate {

void write_registration_state(const std::filesystem::path& file, const LiveSession& session,
                              const RegistrationScreen& screen) {
  const LiveRegistrar::State state = session.state();
  nlohmann::ordered_json json;
  json["work"] = to_string(state.work);
  json["problem"] = session.problem();
  json["received"] = session.stream().received();
  json["unplaced"] = session.stream().unplaced();
  json["shown"] = session.shown();
  json["images_kept"] = state.kept;
  json["images_in_use"] = state.in_use;
  json["spread_mm"] = state.spread_mm;
  json["rounds"] = state.rounds;
  json["refines"] = session.refines();
  json["pictures_drawn"] = screen.drawn;
  json["pictures_per_second"] = screen.pictures_per_second;
  for (const auto& [name, place] : screen.places) {
    json[name + "_x"] = int(place.x);
    json[name + "_y"] = int(place.y);
    json[name + "_w"] = int(place.w);
    json[name + "_h"] = int(place.h);
  }
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      json["ct_from_sweep"][std::size_t(row)].push_back(state.ct_from_sweep[column][row]);
  if (state.last) {
    json["converged"] = state.last->found.converged();
    json["verdict"] = session.verdict();
    json["similarity"] = state.last->found.similarity_after;
    json["expected_error_mm"] = state.last->found.expected_error_mm;
  }
  write_file(file, json.dump(1) + "\n");
}

}  // namespace insonate
