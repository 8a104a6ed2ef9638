#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/pictures/igtl_feed.h"
#include "app/pictures/picture_latency.h"
#include "app/pictures/picture_reader.h"
#include "app/pictures/pictures.h"
#include "app/recording/clip_recorder.h"
#include "app/recording/results.h"
#include "app/recording/run_recorder.h"
#include "app/recording/sweep_recorder.h"
#include "app/replay/replay_source.h"
#include "app/session/guide.h"
#include "app/session/loaded_case.h"
#include "app/session/loading.h"
#include "app/trainer/modes.h"
#include "app/trainer/options.h"
#include "app/trainer/preferences.h"
#include "devices/record/raw_recorder.h"
#include "scenarios/results/database/results_database.h"
#include "scenarios/results/export/report_files.h"

namespace insonate {

/// What has gone well and is worth a sentence.
struct Notice {
  std::string text;
  std::filesystem::path file;  ///< that it is about
};

/// Returns the notice that a file has been written: its name before its folder, so that a line can end between them.
Notice notice_of_saved(const std::filesystem::path& file);

/// The trainer without its screen: loads what is asked for on a thread of its own, runs the session, draws its
/// pictures, writes the results, and collects what went wrong for a dialog. Needs an OpenGL context current, from
/// construction to destruction, on the one thread that uses it.
class Trainer {
public:
  /// Throws InputError if the command line names an address for OpenIGTLink clients or a database of results that
  /// cannot be used.
  /// @param options  with_preferences(), if there are any
  /// @param file  where preferences are stored; empty: nowhere
  explicit Trainer(Options options, Preferences preferences = {}, std::filesystem::path file = {});

  const Preferences& preferences() const { return preferences_; }
  const std::filesystem::path& preferences_file() const { return preferences_file_; }
  /// Applies other preferences at once, and stores them. A value that cannot be used becomes a problem to acknowledge.
  void prefer(const Preferences& preferences);
  /// Shows the patient with a transfer function from a file. A file that cannot be used becomes a problem to
  /// acknowledge.
  void take_look(const std::filesystem::path& file);
  /// Saves how the patient looks now for later patients. A notice names the file.
  void save_look();
  /// Stores how this patient looks, for the next time.
  void keep_look();
  /// Takes another look of the CT at once. A drag changes it with every frame, so keep_ct_look() stores it.
  void adjust_ct_look(const CtLook& look) { preferences_.ct = look; }
  /// Shows or hides the names of landmarks, as a preference.
  void toggle_landmarks();
  /// Returns whether the names of landmarks may be shown. They are help, so during scored steps only while the guide is
  /// on, whose use the result counts.
  bool may_name_landmarks() const;
  /// Stores the look of the CT, if adjust_ct_look() has changed it.
  void keep_ct_look();

  /// Begins to load what the command line names, or shows the start page if it names nothing. Returns at once.
  void open_from_options();
  /// Begins to load a file or folder that a person dropped, typed or chose: a case, a CT, a scenario or a recorded
  /// scan. It replaces what is being loaded. A path that cannot be opened becomes a problem to acknowledge.
  void open(const std::filesystem::path& path);

  /// Returns what is being loaded; nullptr if nothing is.
  const Loading* loading() const { return loading_.get(); }
  /// Waits until it is loaded, and shows it.
  void finish_loading();
  /// Stops loading and continues in the current mode; before the first patient, with the start page.
  void stop_loading();
  /// Returns whether loading can be stopped. An exam that the command line asks for is loaded to its end.
  bool can_stop_loading() const { return !(in_exam() && std::holds_alternative<Idle>(mode_)) && !options_.headless; }

  /// Returns the start page; nullptr in another mode.
  StartPage* start_page() { return const_cast<StartPage*>(std::as_const(*this).start_page()); }
  const StartPage* start_page() const {
    const auto* mode = std::get_if<Choosing>(&mode_);
    return mode ? mode->page.get() : nullptr;
  }
  /// Returns the page of learners; nullptr in another mode.
  LearnersPage* learners_page() { return const_cast<LearnersPage*>(std::as_const(*this).learners_page()); }
  const LearnersPage* learners_page() const {
    const auto* mode = std::get_if<Overseeing>(&mode_);
    return mode ? mode->page.get() : nullptr;
  }
  /// Returns the page that checks a scenario; nullptr in another mode.
  CheckPage* check_page() { return const_cast<CheckPage*>(std::as_const(*this).check_page()); }
  const CheckPage* check_page() const {
    const auto* mode = std::get_if<Checking>(&mode_);
    return mode ? mode->page.get() : nullptr;
  }
  /// Goes from the start page to the page that checks a scenario file, or checks another one there.
  void check_scenario(const std::filesystem::path& file);
  /// Begins to load the checked scenario, to practise it.
  void practise_checked();
  /// Goes from the start page to the page of learners, if there is a database of results.
  void show_learners(const LearnersChoice& choice = {});
  /// Begins to load the attempt that is chosen on the page of learners, to replay it.
  void review();
  /// Writes the report of the attempt that is chosen on the page of learners. A notice names the file.
  void report_attempt();
  /// Writes the database as CSV files. A notice names their folder.
  void export_tables();

  /// Leaves the current mode for the page from which it was begun: the page of learners after a review, the check of a
  /// scenario that is practised from there, and otherwise the start page. Does nothing where can_leave() is false.
  void leave();
  /// Returns whether leave() leads to the page of learners.
  bool leads_to_learners() const;
  /// Returns whether leave() leads to the page that checks a scenario.
  bool leads_to_check() const;
  /// Leaves the current mode for the start page, and begins to load the built-in patient in the background. Does
  /// nothing where can_leave() is false.
  void show_start_page();
  /// Returns whether the current mode may be left: false from the first pose of an exam that was
  /// started to its end.
  bool can_leave() const;
  /// Returns whether leaving throws something away: steps that are scored and not finished.
  bool loses_by_leaving() const;
  /// Returns whether leaving throws away a sweep: one that runs, is reconstructed, or whose volume is not saved.
  bool loses_sweep() const { return !lost_sweep().empty(); }
  /// Returns what becomes of that sweep, and how it is kept, as a sentence; empty if there is none.
  std::string_view lost_sweep() const;
  /// Begins what is chosen on the start page, if nothing hinders it.
  void begin_chosen();

  /// Shows what has been loaded, and advances the current mode to `now_s` (s, steady_now_s() with a live tracker).
  void update(double now_s);
  /// Draws the pictures of the session or replay, and publishes them to OpenIGTLink clients and the recorder.
  void draw(const PictureSizes& sizes, const Effort& effort = {});
  /// Returns whether the picture is better than the best frame so far: draw it, then keep it.
  bool best_frame_due() const { return scan() && scan()->best_frames.due(*session(), picture_tools()); }
  void keep_best_frame() { scan()->best_frames.keep(*session(), picture_tools(), pictures_); }
  /// When an exam has ended, stores the attempt and writes its report and score, once: without a window to
  /// options().out, with one to a folder of its own in there (attempt_folder()), because a person tries again.
  void write_results_if_due();

  /// Returns the scenario whose briefing the learner has to read before the session begins; nullptr if there is none.
  /// The session's time stands still meanwhile. A recorded scan and a run without a window begin at once.
  const Scenario* briefing() const;
  /// Shows the briefing over free practice, which goes on behind it.
  void brief();
  /// Begins the session after the briefing, or over free practice the steps.
  void start();
  /// Goes back from the briefing to free practice, or leaves if the session has not begun.
  void leave_briefing();

  /// Says whether something covers the screen, such as the help, from the next update() on. Time stands still meanwhile
  /// if it can (Session::can_stand_still()).
  void cover(bool covered) { covered_ = covered; }
  /// Returns whether something covers the screen and time does not stand still, which the learner has to know.
  bool time_runs_on() const {
    return covered_ && !briefing() && session() && session()->runner() && !session()->result() &&
           !session()->can_stand_still();
  }

  /// Ends an exam that counts before its end: what has been done is scored and stored.
  void hand_in_exam();
  /// Returns whether the exam that the trainer was started for is refused. Only the reason is shown then.
  bool exam_refused() const { return in_exam() && std::holds_alternative<Idle>(mode_) && !loading_; }
  /// Returns whether the refusal has been acknowledged, so that the trainer can end.
  bool is_over() const { return exam_refused() && problems_.empty(); }

  /// Starts a recording. The first one goes to the command line's file. Others, and all if it names none, get the next
  /// free name beside it or in the folder of the results: recording.igs.mha.
  void start_recording();
  /// Ends the recording. A thread writes the files.
  void stop_recording() { recorder_.stop(); }
  /// Ends the recording and waits for its files.
  void finish_recording();
  const RunRecorder& recorder() const { return recorder_; }
  /// Writes what a person has seen as a PNG, under the time in UTC, to the folder "pictures" of the results.
  void save_picture(const Image<Rgba8>& picture);
  /// Begins a clip of what a person sees, beside the saved pictures; the caller gives its pictures to clip().
  void start_clip();
  ClipRecorder& clip() { return clip_; }
  const ClipRecorder& clip() const { return clip_; }
  /// Begins a sweep, whose live pictures become a volume, or ends it. Does nothing where can_sweep() is false.
  void toggle_sweep();
  /// Returns whether a sweep can be begun or ended: not in an exam that counts, nor while one is reconstructed.
  bool can_sweep() const { return session() && !session()->strict() && !sweep_.reconstructing(); }
  const SweepRecorder& sweep() const { return sweep_; }
  /// Returns the volume of the last sweep over the patient that is shown; nullptr if there is none.
  const std::shared_ptr<const SweptVolume>& swept() const { return swept_; }
  /// Writes that volume under the time in UTC to the folder "volumes" of the results. A notice names the file.
  void save_swept();
  /// Returns the last file with the tracker's bytes; empty if they are not recorded.
  std::filesystem::path raw_file() const { return raw_ ? raw_->file() : std::filesystem::path(); }

  /// Returns the wizard that sets up the tracker; nullptr in another mode.
  SetupWizard* setup() { return const_cast<SetupWizard*>(std::as_const(*this).setup()); }
  const SetupWizard* setup() const {
    const auto* mode = std::get_if<SettingUp>(&mode_);
    return mode ? mode->wizard.get() : nullptr;
  }
  /// Returns whether begin_setup() leaves the session, because no sensor is used there.
  bool setup_leaves() const;
  /// Begins to set up the session's tracker. If it has no sensor, shows where the start page lets another one be
  /// chosen. The set-up begins by itself if the command line names a calibration that is not complete.
  void begin_setup();
  /// Ends the set-up and begins a session, with the calibration if it is complete. A set-up that was begun from the
  /// start page leads back there.
  void end_setup();

  /// Returns a sentence on how to start the trainer with the calibration that is being made.
  std::string next_start() const;

  /// Returns the latency of the pictures; measured only if options().latency names a file.
  const PictureLatency& latency() const { return latency_; }

  /// Returns whether a recorded scan of the built-in patient is shown to somebody who has named nothing.
  bool demonstration() const {
    return !options_.headless && session() && current_.source.is_bundled() && current_.tracker.empty() &&
           session()->holder() == Holder::tracker;
  }

  /// Returns the run that is played again; nullptr in another mode.
  Replay* replay() { return const_cast<Replay*>(std::as_const(*this).replay()); }
  const Replay* replay() const {
    const auto* mode = std::get_if<Playback>(&mode_);
    return mode ? mode->replay.get() : nullptr;
  }
  /// Returns the patient that is shown, with the exam if there is one; nullptr before the first is loaded.
  const LoadedCase* loaded_case() const { return loaded_case_.get(); }

  /// Help for practice.
  Guide& guide() { return guide_; }
  const Guide& guide() const { return guide_; }

  /// Returns the author of a case's views; nullptr in another mode.
  Author* author() { return const_cast<Author*>(std::as_const(*this).author()); }
  const Author* author() const {
    const auto* mode = std::get_if<Authoring>(&mode_);
    return mode ? &mode->author : nullptr;
  }
  /// Stores the view that is being made. If it cannot be stored, the reason becomes a problem to acknowledge.
  void keep_view();

  /// Returns the session of practice, an exam or authoring; nullptr in another mode.
  Session* session() { return scan() ? scan()->session.get() : nullptr; }
  const Session* session() const { return scan() ? scan()->session.get() : nullptr; }
  /// Return the session's tools and controls. Call them only while there is a session.
  PictureTools& picture_tools() { return scan()->tools; }
  const PictureTools& picture_tools() const { return scan()->tools; }
  StepControls& step_controls() { return scan()->controls; }
  UndoHistory& undo_history() { return scan()->undo; }
  const StepControls& step_controls() const { return scan()->controls; }
  Pictures& pictures() { return pictures_; }
  const Pictures& pictures() const { return pictures_; }
  const Options& options() const { return options_; }
  const std::optional<ResultFiles>& result_files() const { return result_files_; }
  /// Returns whether an exam has ended whose report the next write_results_if_due() writes.
  bool results_due() const { return results_due_; }
  /// Returns the ultrasound picture of the best hold in the last step that had one, marker on the left; nullptr if
  /// there was none.
  const Image<Rgba8>* best_frame() const { return scan() ? scan()->best_frames.last() : nullptr; }

  /// Returns the errors that nobody has acknowledged yet, as sentences, the oldest first.
  std::deque<std::string>& problems() { return problems_; }
  const std::deque<std::string>& problems() const { return problems_; }
  /// Returns what sends to other programs; nullptr when nothing does.
  const IgtlFeed* feed() const { return feed_.get(); }
  /// Returns what has gone well since the last call, such as the file of a recording.
  std::vector<Notice> take_notices() { return std::exchange(notices_, {}); }
  /// Returns sentences on why the tracker's calibration may be wrong; empty if nothing speaks against it.
  const std::string& calibration_warning() const { return calibration_warning_; }
  /// Returns the compiler's message if the edited shaders do not build, at loading or later for new settings; empty
  /// otherwise. The picture then stays as it was, or is black if the probe or its depth has changed.
  const std::string& shader_problem() const { return shader_problem_; }

  /// Runs `action`. With a window, an exception becomes a problem to acknowledge; without one it passes through.
  /// Returns whether nothing was thrown.
  bool attempt(const std::function<void()>& action);

private:
  Scan* scan() { return scan_of(mode_); }
  const Scan* scan() const { return scan_of(const_cast<TrainerMode&>(mode_)); }
  /// Returns whether the trainer was started for an exam that counts, in any mode.
  bool in_exam() const { return options_.mode == Mode::exam; }
  struct Request {
    CaseSource source;
    std::string tracker;             ///< URI; empty: the bundled log with the bundled exam, else the learner's own hand
    ReplaySource replay;             ///< what is looked at again, in place of a session
    bool free_practice = false;      ///< without the scenario's steps
    bool is_opened_patient = false;  ///< a CT or case that a person has opened by its path
  };
  /// Throws, on the loading thread, what the session will throw for reasons that have nothing to do with the patient: a
  /// patient can take a minute to make.
  std::function<void()> refusals(const Request& request);
  void begin(const Beginning& chosen);
  void load(Request request);
  bool load_prepared();
  Request request_of(const Options& options, bool free_practice) const;
  void prepare_built_in();
  void take_over_prepared();
  void give_up_choice();
  void take_over_loaded();
  void begin(std::shared_ptr<const LoadedCase> loaded_case, const Request& request);
  std::uint32_t seed() const;
  void refuse_second_exam(const Scenario& exam);
  void keep_sitting(Exam& exam);
  void update(Idle&, double) {}
  void update(Choosing& mode, double now_s) {
    notice_recordings();
    mode.page->update(now_s);
  }
  void update(Overseeing& mode, double) {
    notice_recordings();
    mode.page->update();
  }
  void update(Checking& mode, double now_s) { mode.page->update(now_s); }
  void update(Playback& mode, double now_s) { mode.replay->advance(now_s); }
  void update(SettingUp& mode, double now_s);
  template <std::derived_from<Scan> Mode>
  void update(Mode& mode, double now_s);
  void begin_replay(std::shared_ptr<const LoadedCase> loaded_case, const Request& request);
  void show(std::shared_ptr<const LoadedCase> loaded_case, const Request& request);
  std::filesystem::path own_calibration(const std::string& uri) const;
  void find_calibration();
  bool uses_calibration(const Request& request) const;
  bool needs_setup(const Request& request) const;
  bool can_be_set_up(const Request& request) const;
  Session::OpenTracker opener(const std::string& uri, const LoadedCase& loaded_case, bool calibrated);
  void record_raw(Session& session, const Request& request);
  void check_raw();
  void open_setup();
  void reload_shaders();
  void report_shader_problem(const std::string& problem);
  void open_results();
  void use_results(const std::filesystem::path& file);
  void make_start_page();
  void serve();
  void append_patient(const std::filesystem::path& path);
  void remember(const StartPage& page);
  void forget_patient(const CaseSource& patient);
  void keep_preferences();
  void notice_recordings();
  void notice_sweep();
  void keep_and_report();
  void show_pictures();

  Options options_;
  Preferences preferences_;
  CtLook kept_ct_look_;
  std::filesystem::path preferences_file_;
  Options given_;  ///< the command line's; on the start page and behind it options_ are the chosen ones
  std::optional<std::filesystem::file_time_type> shaders_changed_;
  double shaders_looked_at_s_ = 0;
  std::string shader_problem_, calibration_warning_;
  std::string why_not_calibrated_;  ///< by what an earlier set-up has left; a sentence, mostly empty

  Request current_, requested_;
  std::unique_ptr<Loading> loading_;
  std::shared_ptr<Loading> preparing_;          ///< the built-in patient, behind the start page
  std::shared_ptr<const LoadedCase> built_in_;  ///< the patient of the bundled exam, while the start page is shown

  std::shared_ptr<const LoadedCase> loaded_case_;
  TrainerMode mode_;
  std::shared_ptr<std::unique_ptr<Replay>> loaded_replay_;  ///< filled in by loading_; nullptr unless it loads a replay
  Guide guide_;
  bool setup_left_ = false;  ///< before it was complete: the tracker is used without
  Pictures pictures_;
  PictureLatency latency_;
  PictureReader reader_;
  RunRecorder recorder_;
  ClipRecorder clip_;
  SweepRecorder sweep_;
  std::shared_ptr<const LoadedCase> sweep_case_;  ///< that the sweep is over
  std::shared_ptr<const SweptVolume> swept_;
  bool swept_is_saved_ = false;
  bool recorded_ = false;                   ///< to the command line's file
  std::shared_ptr<const RawRecorder> raw_;  ///< of the newest session; nullptr when nobody asked for it
  bool clients_ = false, records_pictures_ = false, sweeps_ = false;  ///< who wanted pictures at the last frame
  std::unique_ptr<IgtlFeed> feed_;                                    ///< nullptr when no clients are asked for
  std::optional<ResultFiles> result_files_;
  Task begun_ = Task::first_scan;                 ///< last begun on the start page, which shows it again
  std::filesystem::path begun_scenario_;          ///< likewise; empty: none
  std::optional<LearnersChoice> reviewed_;        ///< on the page of learners, from which the replay was begun
  std::optional<std::filesystem::path> checked_;  ///< scenario on the page from which practice was begun
  bool covered_ = false;
  bool results_due_ = false;
  std::optional<ResultsDatabase> results_;
  std::deque<std::string> problems_;
  std::vector<Notice> notices_;
};

}  // namespace insonate
