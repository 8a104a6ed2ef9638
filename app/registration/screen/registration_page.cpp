#include "app/registration/screen/registration_page.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/core/text.h"

namespace insonate::ui {
namespace {

using Work = LiveRegistrar::Work;

std::string work_text(const LiveSession& session, const LiveRegistrar::State& state) {
  switch (state.work) {
    case Work::waiting:
      if (session.shown() == 0) return "Waiting for images";
      return std::string(state.needs.spread_mm < kMinSpread_mm ? "Move the probe: "
                                                               : "Move the probe, and the search begins: ") +
             std::to_string(state.in_use) + " images within " + formatted("%.0f", state.spread_mm) +
             " mm; needed are " + to_string(state.needs);
    case Work::preparing:
      return "Preparing shaders and volumes";
    case Work::refining:
      return "Refining";
    case Work::searching:
      return "Searching widely";
    case Work::resting:
      return session.refines() ? "Waiting for new images" : "Refining is off";
    case Work::failed:
      break;
  }
  return "The registration has ended";
}

std::string moved_text(const SweepRegistration& found) {
  const std::vector<double>& at = found.at;
  return formatted("%.1f mm and %.1f\u00b0", std::hypot(at[0], at[1], at[2]),
                   glm::degrees(std::hypot(at[3], at[4], at[5]) / found.motion.radius_mm));
}

}  // namespace

void RegistrationPage::draw_picture(const Theme& theme, const Rect& where, const char* name, const char* title,
                                    const gl::Texture& texture, bool shown) {
  places_[name] = where;
  fill(where, colour::kImage, theme.px(4));
  if (shown) {
    const float scale = std::min(where.w / float(texture.width()), where.h / float(texture.height()));
    const ImVec2 half(scale * float(texture.width()) / 2, scale * float(texture.height()) / 2), middle = where.centre();
    ImGui::GetWindowDrawList()->AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(texture.name())),
                                         {middle.x - half.x, middle.y - half.y},
                                         {middle.x + half.x, middle.y + half.y});
  }
  draw_text({where.x + theme.px(12), where.y + theme.px(8), where.w - theme.px(24), theme.px(24)}, theme.strong,
            colour::kText, title);
}

void RegistrationPage::draw_facts(const Theme& theme, Rect where, const LiveSession& session,
                                  double pictures_per_second) const {
  const LiveRegistrar::State state = session.state();
  const auto line = [&](const char* name, const std::string& value) {
    Rect row = where.take_top(theme.px(26));
    draw_text(row.take_left(theme.px(190)), theme.text, colour::kMuted, name);
    draw_text(row, theme.text, colour::kText, value);
  };
  line("Registration", work_text(session, state));
  line("Images",
       std::to_string(session.stream().received()) + " received, " + std::to_string(state.kept) + " kept, " +
           std::to_string(state.in_use) + " in use" +
           (session.stream().unplaced() > 0 ? ", " + std::to_string(session.stream().unplaced()) + " without a pose"
                                            : ""));
  if (session.fan()) line("Probe, as found", description(*session.fan()));
  if (state.last) {
    const SweepRegistration& found = state.last->found;
    line("Similarity (LC2)", formatted("%.3f", found.similarity_after) + ", before the last round " +
                                 formatted("%.3f", found.similarity_before));
    line("Expected error", found.deviation.empty()
                               ? "not known: the similarity has no maximum there"
                               : formatted("%.2f mm, from the similarity's curvature", found.expected_error_mm));
    line("The last round moved it", moved_text(found) + ", in " + formatted("%.1f", found.seconds) + " s");
    line("Rounds", std::to_string(state.rounds));
  }
  line("Pictures", pictures_per_second > 0 ? formatted("%.0f a second", pictures_per_second) : "none now");
}

RegistrationWish RegistrationPage::draw_buttons(const Theme& theme, Rect row, const LiveSession& session) {
  const LiveRegistrar::State state = session.state();
  RegistrationWish wish;
  const auto next = [&](const char* id, const std::string& text, ButtonKind kind, bool enabled, const char* tip) {
    Rect where = row.take_left(theme.px(170));
    row.take_left(theme.px(10));
    places_[id] = where;
    return button(theme, id, where, text, kind, enabled, tip);
  };
  const bool begun = session.shown() > 0 && state.work != Work::failed;
  wish.refine = next("refine", session.refines() ? "Refining" : "Refine",
                     session.refines() ? ButtonKind::chosen : ButtonKind::normal, begun,
                     "Follow the estimate with each new choice of images (F)");
  wish.search = next("search", state.work == Work::searching ? "Searching" : "Search widely", ButtonKind::primary,
                     begun && state.work != Work::searching,
                     "Look for other places too. Only a search that finds none makes the estimate count (W)");
  wish.reset = next("reset", "Back to the start", ButtonKind::normal, begun, "Forget what was found (Backspace)");
  wish.save = next("save", "Save", ButtonKind::normal, state.last != nullptr,
                   "Write the transform with its verdict, as insonate-register does (S)");
  return wish;
}

RegistrationWish RegistrationPage::draw(const Theme& theme, const Rect& screen, const LiveSession& session,
                                        const RegistrationPictures& pictures, double pictures_per_second,
                                        const std::string& notice) {
  places_.clear();
  ImGui::SetNextWindowPos(screen.min());
  ImGui::SetNextWindowSize({screen.w, screen.h});
  ImGui::Begin("registration", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoScrollWithMouse);
  Rect rest = screen.inset(theme.px(16), theme.px(12));
  draw_text(rest.take_top(theme.px(40)), theme.heading, colour::kText, "Registration of live ultrasound");

  // What hinders stands before the verdict, and both before the pictures.
  const std::string problem = session.problem(), verdict = session.verdict();
  const auto last = session.state().last;
  const bool good = problem.empty() && last && last->found.converged();
  const std::string& said = !problem.empty() ? problem : verdict;
  Rect plate = rest.take_top(theme.px(54));
  fill(plate, colour::kPanel, theme.px(4));
  fill(plate.take_left(theme.px(5)), said.empty() ? colour::kLine : good ? colour::kAccent : colour::kAmber);
  draw_paragraph(plate.inset(theme.px(12), theme.px(7)), theme.text, said.empty() ? colour::kMuted : colour::kText,
                 said.empty() ? "Nothing has been registered yet." : said);
  rest.take_top(theme.px(10));

  Rect buttons = rest.take_bottom(theme.px(44));
  rest.take_bottom(theme.px(10));
  const Rect facts = rest.take_bottom(theme.px(8 * 26 + 6));
  rest.take_bottom(theme.px(6));
  const float gap = theme.px(8), each = (rest.w - 2 * gap) / 3;
  const bool shown = pictures.drawn() > 0;
  const auto picture = [&](const char* name, const char* title, const gl::Texture& texture) {
    draw_picture(theme, rest.take_left(each), name, title, texture, shown);
    rest.take_left(gap);
  };
  picture("received", "Received", pictures.received());
  picture("simulated", "Simulated at the estimate", pictures.simulated());
  picture("blended", "Both: received orange, simulated blue", pictures.blended());
  draw_facts(theme, facts, session, pictures_per_second);
  draw_text({buttons.x + theme.px(740), buttons.y, buttons.w - theme.px(740), buttons.h}, theme.small_text,
            colour::kMuted, notice, Align::right);
  const RegistrationWish wish = draw_buttons(theme, buttons, session);
  ImGui::End();
  return wish;
}

}  // namespace insonate::ui
