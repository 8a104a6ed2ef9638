#pragma once

#include <map>
#include <optional>
#include <string>

#include "app/panels/widgets/widgets.h"
#include "app/pictures/patient_look.h"

namespace insonate::ui {

/// What a person has asked for on the panel.
enum class LookAnswer { none, close, save, open };

/// Chooses and edits how the patient looks in the 3D view: the looks, the transfer function over the CT's histogram
/// with points to drag, two sliders that move the function as a whole, colours for the chosen point, and the structures
/// whose surfaces are shown within the CT.
class LookPanel {
public:
  /// @param places  receives the places of buttons and points
  LookAnswer draw(const Theme& theme, const Rect& panel, PatientLook& look, std::map<std::string, Rect>& places);

private:
  void draw_graph(const Theme& theme, const Rect& graph, PatientLook& look, std::map<std::string, Rect>& places);
  void draw_colours(const Theme& theme, const Rect& where, PatientLook& look,
                    std::map<std::string, Rect>& places) const;
  void draw_structures(const Theme& theme, const Rect& where, PatientLook& look,
                       std::map<std::string, Rect>& places) const;

  std::optional<std::size_t> point_;  ///< chosen for its colour
};

}  // namespace insonate::ui
