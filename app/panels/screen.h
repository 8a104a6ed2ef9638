#pragma once

#include <map>
#include <optional>
#include <string>

#include "app/panels/overlays.h"
#include "app/panels/score_sheet.h"
#include "app/panels/theme.h"
#include "app/panels/views_panel.h"
#include "app/panels/widgets.h"
#include "app/trainer.h"

namespace insonate::ui {

/// The trainer's whole screen: owns ImGui and its OpenGL renderer, lays the panels out, and shows what lies over them.
/// Draws into whatever framebuffer is bound, so it does not know whether there is a window. Needs an OpenGL context.
class Screen {
public:
  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Draws a frame. ImGui's display size, time step and input are set by the caller before.
  void render(Trainer& trainer);

  /// How many pixels the pictures have on a screen of that size.
  PictureSizes picture_sizes(float width, float height);

  void toggle_help() { help_ = !help_; }
  void ask_for_path() { asking_ = true; }
  /// Closes what lies over the screen and can be closed without an answer.
  void dismiss();
  /// Something lies over the screen, or text is typed: keys do not move the probe.
  bool takes_keys(const Trainer& trainer) const;

  /// What lies over the screen: "problem", "loading", "help", "open", "score", or "" for nothing.
  std::string overlay(const Trainer& trainer) const;
  void set_frames_per_second(double fps) { frames_per_second_ = fps; }
  /// Where the panels are, by name.
  const std::map<std::string, Rect>& places() const { return places_; }

private:
  void lay_out(float width, float height);
  void draw_panels(Trainer& trainer);
  void draw_overlay(Trainer& trainer);
  void draw_status(Trainer& trainer);
  void answer_score(Trainer& trainer, ScoreAnswer answer);

  struct ImGuiOwner {
    ImGuiOwner();
    ~ImGuiOwner();
  } imgui_;
  Theme theme_;
  std::string device_;
  SpacePanel space_;
  OpenDialog open_dialog_;
  bool help_ = false, asking_ = false;
  const ExamResult* closed_sheet_of_ = nullptr;
  double frames_per_second_ = 0;
  Rect screen_, top_, ultrasound_, volume_, slice_, blend_, console_, status_;
  std::map<std::string, Rect> places_;
};

}  // namespace insonate::ui
