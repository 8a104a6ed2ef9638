#include "app/state_file.h"

#include <nlohmann/json.hpp>

#include "scenarios/caliper.h"
#include "sim/files/files.h"

namespace insonate {
namespace {

using Json = nlohmann::ordered_json;

void write_machine(Json& state, const Machine& machine) {
  state["frozen"] = machine.frozen;
  state["probe"] = machine.probe;
  state["depth_mm"] = machine.depth_mm;
  state["gain_db"] = machine.gain_db;
}

void write_pose(Json& state, const Pose& pose) {
  for (int axis = 0; axis < 3; ++axis) {
    state[std::string("face_") + "xyz"[axis]] = pose.translation[axis];
    state[std::string("beam_") + "xyz"[axis]] = pose.rotation[1][axis];
    state[std::string("marker_") + "xyz"[axis]] = pose.rotation[0][axis];
  }
}

void write_views(Json& state, const Trainer& trainer, const ui::Screen& screen) {
  const Preferences& preferences = trainer.preferences();
  state["layout"] = kLayoutNames[std::size_t(preferences.look.layout)];
  state["large"] = screen.large() ? name_of(*screen.large()) : "";
  state["landmarks"] = preferences.look.landmarks;
  state["ct_window"] = preferences.ct.grey.window_hu;
  state["ct_level"] = preferences.ct.grey.level_hu;
  state["ct_outlines"] = preferences.ct.outlines;
  state["blend_colour"] = int(preferences.ct.blend_colour);
  state["cross_hair"] = preferences.ct.cross_hair == CrossHair::face ? "face" : "fan";
  state["axial_offset_mm"] = trainer.pictures().slice_offset_mm(view::SliceAxis::axial);
}

/// Returns a short text for an annotation: its slot and value, or its name.
std::string in_short(const Action& placed) {
  if (placed.kind == ActionKind::caliper || placed.kind == ActionKind::ellipse)
    return std::to_string(placed.slot()) + " " + value_text(placed) + "; ";
  return (placed.kind == ActionKind::point ? "point" : placed.text) + "; ";
}

}  // namespace

void write_state(const std::filesystem::path& file, Trainer& trainer, const ui::Screen& screen, long frames, long shown,
                 double quality) {
  Json state;
  state["overlay"] = to_string(screen.overlay(trainer));
  state["toast"] = screen.toast().text();
  state["cut_texts"] = screen.cut_texts();
  state["problem"] = trainer.problems().empty() ? "" : trainer.problems().front();
  state["shader_problem"] = trainer.shader_problem();
  state["calibration_warning"] = trainer.calibration_warning();
  state["frames"] = frames;
  state["frames_shown"] = shown;
  state["pictures_drawn"] = trainer.pictures().drawn();
  state["quality"] = quality;
  state["simulator_runs"] = trainer.pictures().simulator_runs();
  state["recording"] = trainer.recorder().running() ? trainer.recorder().file().string() : "";
  for (const auto& [name, rect] : screen.places()) {
    state[name + "_x"] = int(rect.x);
    state[name + "_y"] = int(rect.y);
    state[name + "_w"] = int(rect.w);
    state[name + "_h"] = int(rect.h);
  }
  state["depth_unit"] = trainer.preferences().look.length_unit == LengthUnit::mm ? "mm" : "cm";
  state["clip"] = trainer.clip().running();
  state["sweeping"] = trainer.sweep().running();
  if (trainer.sweep().running()) state["sweep_pictures"] = trainer.sweep().quality().pictures;
  if (trainer.swept()) {
    const view::MprPlanes& planes = screen.volume_page().planes();
    state["swept_pictures"] = trainer.swept()->quality.pictures;
    state["swept_verdict"] = trainer.swept()->quality.verdict();
    state["planes_turned_deg"] = planes.turned_deg();
    for (int axis = 0; axis < 3; ++axis) state[std::string("planes_") + "xyz"[axis]] = planes.centre()[axis];
  }
  state["camera_yaw_deg"] = trainer.pictures().camera.yaw_deg;
  state["camera_pitch_deg"] = trainer.pictures().camera.pitch_deg;
  state["camera_distance_mm"] = trainer.pictures().camera.distance_mm;
  state["camera_centre_x"] = trainer.pictures().camera.centre.x;
  write_views(state, trainer, screen);
  if (const StartPage* page = trainer.start_page()) {
    state["start_task"] = to_string(page->task);
    state["start_why_not"] = page->why_not();
    state["start_learner"] = page->learner();
    state["start_tracker"] = page->tracker();
    state["typing"] = screen.types_text(trainer);
  }
  if (const CheckPage* page = trainer.check_page()) {
    state["check_file"] = page->file().string();
    state["check_state"] = page->state() == CheckPage::State::checking ? "checking"
                           : page->state() == CheckPage::State::right  ? "right"
                                                                       : "wrong";
    state["check_problems"] = page->problems().size();
    state["check_line"] = page->chosen() ? page->problems()[*page->chosen()].place.line : 0;
    state["check_lines"] = page->lines().size();
    state["check_failure"] = page->failure();
    state["checks"] = page->checks();
  }
  if (const LearnersPage* page = trainer.learners_page()) {
    state["learners"] = page->learners().size() - 1;
    state["learners_learner"] = page->choice().learner;
    state["learners_scenario"] = page->trend().title;
    state["learners_mode"] = name_of(page->choice().mode);
    state["learners_attempt"] = page->choice().attempt;
    state["learners_attempts"] = page->attempts().size();
    state["learners_criteria"] = page->trend().criteria.size();
    state["learners_author"] = page->choice().author;
    state["learners_comments"] = page->comments().size();
    state["learners_comment"] = page->comments().empty() ? "" : page->comments().back().text;
    state["typing"] = screen.types_text(trainer);
  }
  if (const SetupWizard* setup = trainer.setup()) {
    const SetupView view = setup->view();
    state["setup_step"] = kSetupSteps[setup->current()];
    state["setup_done"] = view.done;
    state["setup_reading"] = view.reading;
    state["setup_part"] = view.part;
    state["setup_task"] = view.task;
    state["setup_feedback"] = view.feedback;
    state["setup_rehearsal"] = setup->rehearsal();
    state["setup_refusal"] = view.refusal;
    state["setup_result"] = view.result;
  }
  if (const Replay* replay = trainer.replay()) {
    state["replay_run"] = replay->run().name;
    state["replay_s"] = replay->time_s();
    state["replay_duration_s"] = replay->run().duration_s();
    state["replay_playing"] = replay->playing();
    state["replay_speed"] = replay->speed();
    state["step"] = replay->moment().step;
    write_machine(state, replay->machine());
    std::string placed;
    for (const ShownAnnotations::Placed& annotation : replay->annotations().placed)
      placed += in_short(annotation.action);
    state["placed"] = placed;
    if (const auto& pose = replay->moment().shown_pose) write_pose(state, *pose);
  }
  if (const Session* session = trainer.session()) {
    state["patient"] = session->loaded_case().subject.name;
    state["activity"] = session->activity() == Activity::exam ? "exam" : "practice";
    state["holder"] = session->holder() == Holder::learner ? "learner" : "tracker";
    state["tracker"] = to_string(session->tracker_state().condition);
    state["tracker_problem"] = session->tracker_state().problem;
    state["tracker_rejected"] = to_string(session->tracker_state().rejected);
    state["marks"] = session->event_markers_s().size();
    state["pose_answer"] = session->pose_estimate() ? to_string(session->pose_estimate()->how) : "";
    state["lost"] = session->lost_for_s().has_value();
    write_machine(state, session->machine());
    if (const auto& pose = session->shown_pose()) {
      if (const auto space = screen.places().find("space"); space != screen.places().end()) {
        const ui::Rect& panel = space->second;
        const glm::dvec2 face = trainer.pictures().camera.project(pose->translation, int(panel.w), int(panel.h));
        state["probe_on_screen_x"] = int(face.x + panel.x);
        state["probe_on_screen_y"] = int(face.y + panel.y);
      }
      write_pose(state, *pose);
    }
    const PlaneOnScreen plane = screen.plane_on_screen(trainer);
    for (const auto& [name, mm] : {std::pair{"origin", glm::dvec2(0.0)}, {"at_10_10_mm", glm::dvec2(10.0)}}) {
      state[std::string("plane_") + name + "_x"] = plane.screen(mm).x;
      state[std::string("plane_") + name + "_y"] = plane.screen(mm).y;
    }
    std::string placed;
    const Annotations& annotations = trainer.picture_tools().annotations();
    for (const auto& [slot, annotation] : annotations.measured()) placed += in_short(annotation.action);
    if (annotations.point()) placed += in_short(annotations.point()->action);
    for (const auto& [name, annotation] : annotations.labels()) placed += in_short(annotation.action);
    state["placed"] = placed;
    state["can_measure"] = PictureTools::ready(*session);
    state["draft"] = trainer.step_controls().draft();
    state["typing"] = screen.types_text(trainer);
    if (const Runner* runner = session->runner()) {
      state["step"] = runner->live().step;
      state["hints"] = runner->live().hints.size();
      state["elapsed_s"] = runner->live().elapsed_s;
      // A strict exam does not reveal whether the view is found.
      if (!session->strict() || runner->live().finished) state["hold_share"] = runner->live().hold_share;
      state["finished"] = runner->live().finished;
    }
    state["strict"] = session->strict();
    state["demonstration"] = trainer.demonstration();
    if (const Author* author = trainer.author()) {
      std::string wanted;
      for (const Author::Part& part : author->parts())
        if (part.wanted) wanted += part.name + "; ";
      state["wanted"] = wanted;
      state["view_title"] = author->title();
      state["kept_view"] = author->kept();
    }
    if (const std::optional<Guiding> guiding = trainer.guide().now(*session)) {
      state["guided_to"] = guiding->view->name;
      state["advice"] = guiding->advice.empty() ? "" : guiding->advice.front();
    }
    if (session->result()) state["percent"] = session->result()->percent;
    state["report"] = trainer.result_files() ? trainer.result_files()->report.string() : "";
  }
  write_file(file, state.dump(1) + "\n");
}

}  // namespace insonate
