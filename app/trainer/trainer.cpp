#include "app/trainer/trainer.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <utility>

#include "devices/calibrated_tracker.h"
#include "devices/live/steady_clock.h"
#include "devices/registry.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/imaging/upload.h"
#include "sim/tissue/skin_contact.h"

namespace insonate {
namespace {

std::string bundled_log() {
  return "replay:" + (assets_folder() / "logs" / "ruq_good.igs.mha").string();
}

/// Returns a sentence for the learner, who may look at the picture alone, when a step gives way to another; nothing if
/// they ended it themselves before it was done, or may come back to it.
std::string how_step_ended(const Runner& runner, std::size_t step) {
  if (!runner.has_ended(step)) return "";
  const std::string number = "Step " + std::to_string(step + 1);
  switch (runner.result().steps[step].outcome) {
    case StepOutcome::held:
      return number + " is done: the view was held.";
    case StepOutcome::done:
      return number + " is done.";
    case StepOutcome::timed_out:
      return number + " is over: its time was up.";
    default:
      return "";
  }
}

/// What a person calls the patient of a loaded_case.
std::string patient_of(const CaseSource& source) {
  for (const std::filesystem::path& named : {source.ct, source.case_folder, source.scenario})
    if (!named.empty()) return named.string();
  return "the built-in patient";
}

/// Every CT of a patient has air around the body. Labels, or images whose values are not Hounsfield units, have none.
bool has_air(const Volume<std::int16_t>& ct) {
  return std::any_of(ct.voxels.begin(), ct.voxels.end(), [](std::int16_t hu) { return hu < kSkin_hu; });
}

gl::ShaderSources shaders_of(const Options& options) {
  return options.shader_folder.empty() ? gl::ShaderSources() : gl::ShaderSources(options.shader_folder);
}

}  // namespace

Trainer::Trainer(Options options, Preferences preferences, std::filesystem::path file)
    : options_(std::move(options)),
      preferences_(std::move(preferences)),
      kept_ct_look_(preferences_.ct),
      preferences_file_(std::move(file)),
      given_(options_),
      shaders_changed_(gl::last_change(options_.shader_folder)),
      pictures_(shaders_of(options_), quality_named(options_.quality)),
      recorder_(options_.record_images) {
  if (!options_.igtl_server.empty())
    feed_ = std::make_unique<IgtlFeed>(parse_server_address(options_.igtl_server));
  else
    serve();
  open_results();
  if (!preferences_file_.empty())
    for (const std::string& problem : pictures_.look.use_folder(preferences_file_.parent_path() / "transfer_functions"))
      problems_.push_back(problem);
}

void Trainer::open_from_options() {
  if (begins_on_start_page(options_)) return show_start_page();
  if (options_.mode == Mode::check) return check_scenario(options_.scenario);
  find_calibration();
  load(request_of(options_, false));
}

Trainer::Request Trainer::request_of(const Options& options, bool free_practice) const {
  ReplaySource replay = options.replay;
  replay.database = options.results;
  return {CaseSource{options.case_folder, options.ct, options.scenario, std::nullopt, seed()}, options.tracker,
          std::move(replay), free_practice};
}

void Trainer::open(const std::filesystem::path& path) {
  attempt([&] {
    if (check_page() && kind_of_material(path) == Material::scenario) return check_scenario(path);
    if (in_exam()) throw InputError(path.string(), "", "an exam that counts is taken as it is", "open it in practice");
    Request next;
    if (const StartPage* page = start_page()) {
      given_ = page->options();
    }
    const Material kind = kind_of_material(path);
    next.is_opened_patient = kind == Material::ct || kind == Material::case_folder;
    if (start_page() || learners_page() || check_page()) {
      options_ = given_;
      find_calibration();
      next.tracker = options_.tracker;
    }
    switch (kind) {
      case Material::case_folder:
        next.source.case_folder = path;
        break;
      case Material::ct:
        next.source.ct = path;
        break;
      case Material::scenario:
        next.source.scenario = path;
        break;
      case Material::tracker_log:
      case Material::raw_log:
        next = loading_ ? requested_ : current_;
        next.replay = {};
        next.tracker = (kind == Material::raw_log ? "raw:" : "replay:") + path.string();
        if (loaded_case_ && !loading_) return begin(loaded_case_, next);
        break;
    }
    load(next);
  });
}

bool Trainer::attempt(const std::function<void()>& action) {
  try {
    action();
    return true;
  } catch (const std::exception& error) {
    if (options_.headless) throw;
    problems_.emplace_back(error.what());
    return false;
  }
}

std::function<void()> Trainer::refusals(const Request& request) {
  const bool calibrated = uses_calibration(request) && !setup_left_;
  bool exam = false;
  std::exception_ptr refused;
  try {
    if (calibrated && !needs_setup(request)) read_complete_calibration(options_.calibration);
    const std::optional<Scenario> scenario = read_exam(request.source);
    if (in_exam() && scenario) refuse_second_exam(*scenario);
    exam = scenario.has_value();
  } catch (const InputError&) {
    refused = std::current_exception();
  }
  return [refused, exam, calibrated, uri = request.tracker] {
    if (refused) std::rethrow_exception(refused);
    const std::unique_ptr<Tracker> tracker = uri.empty() ? nullptr : open_unless_device(uri);
    if (!tracker) return;
    if (!calibrated) check_source(*tracker, exam);
    if (const Recording* recording = tracker->recording()) parse_action_log(recording->actions, recording->file);
  };
}

void Trainer::load(Request request) {
  requested_ = std::move(request);
  loaded_replay_.reset();
  if (load_prepared()) return;
  if (!requested_.replay.any()) {
    loading_ = std::make_unique<Loading>(
        [source = requested_.source, refuse = refusals(requested_)](const LoadProgress& progress) {
          refuse();
          return std::make_shared<const LoadedCase>(load_case(source, progress));
        });
    return;
  }
  loaded_replay_ = std::make_shared<std::unique_ptr<Replay>>();
  loading_ = std::make_unique<Loading>([request = requested_, replay = loaded_replay_](const LoadProgress& progress) {
    LoadedReplay loaded = load_replay(request.replay, request.source, progress);
    *replay = std::move(loaded.replay);
    return loaded.loaded_case;
  });
}

void Trainer::finish_loading() {
  if (loading_) take_over_loaded();
}

void Trainer::stop_loading() {
  if (!can_stop_loading()) return;
  loading_.reset();
  if (std::holds_alternative<Idle>(mode_)) return show_start_page();
  give_up_choice();
}

void Trainer::take_over_loaded() {
  const std::unique_ptr<Loading> loaded = std::move(loading_);
  std::shared_ptr<const LoadedCase> patient;
  const bool loads = attempt([&] { patient = loaded->take(); });
  if (loads && requested_.is_opened_patient) {  // as if it had been opened on the start page
    append_patient(path_of(requested_.source));
    keep_preferences();
    begun_ = Task::patients;
  }
  if (loads) attempt([&] { begin(std::move(patient), requested_); });
  give_up_choice();
  if (StartPage* page = start_page();
      page && !loads && requested_.source.scenario.empty() && !requested_.replay.any()) {
    page->withdraw(requested_.source);
    forget_patient(requested_.source);
  }
  // A trainer whose command line names something unusable goes on with the start page, and with nothing but the exam if
  // that was asked for.
  if (std::holds_alternative<Idle>(mode_) && !in_exam()) show_start_page();
}

void Trainer::begin(std::shared_ptr<const LoadedCase> loaded_case, const Request& request) {
  if (request.replay.any()) return begin_replay(std::move(loaded_case), request);
  std::string uri = request.tracker;
  if (uri.empty()) uri = request.source.is_bundled() ? bundled_log() : "mouse:";
  if (needs_setup(request)) {
    mode_ = Idle();
    show(std::move(loaded_case), request);
    return open_setup();
  }
  const Session::OpenTracker open = opener(uri, *loaded_case, uses_calibration(request) && !setup_left_);
  if (in_exam()) refuse_second_exam(*loaded_case->scenario);
  auto session = std::make_unique<Session>(loaded_case, open, options_.predict_ms / 1e3,
                                           in_exam() ? ExamRules::strict : ExamRules::open);
  if (in_exam() && !session->can_take_steps())
    throw InputError(uri, "", "a made-up hand takes no exam", "name the tracker that the learner holds");
  if (in_exam() && std::as_const(*session).source().recording())
    throw InputError(uri, "", "a recorded scan is nobody's exam", "name the tracker that the learner holds");
  record_raw(*session, request);
  show(std::move(loaded_case), request);
  Scan scan{std::move(session), {}, {}, {}, {}};
  if (request.free_practice) scan.session->practise();
  scan.begun = options_.headless || !scan.session->runner() || std::as_const(*scan.session).source().recording();
  const bool authoring = options_.mode == Mode::author && request.source.case_folder == options_.case_folder;
  if (in_exam())
    mode_ = Exam{std::move(scan), nullptr};
  else if (authoring && !loaded_case_->scenario)
    mode_ = Authoring{std::move(scan), Author(options_.case_folder)};
  else
    mode_ = Practice{std::move(scan)};
  reader_.forget();
  recorder_.begin_anew();
  result_files_.reset();
}

void Trainer::show(std::shared_ptr<const LoadedCase> loaded_case, const Request& request) {
  if (loaded_case != loaded_case_) {
    keep_look();
    gl::upload_ct(patient_of(request.source), loaded_case->subject.ct.grid, [&] { pictures_.show(*loaded_case); });
    preferences_.ct.grey = {};
    if (!request.source.ct.empty() && !has_air(loaded_case->subject.ct))
      notices_.push_back({request.source.ct.filename().string() +
                              " holds no air around a body: it may be labels or another image, not a CT",
                          {}});
    guide_.forget_made();
    sweep_.stop();
    swept_.reset();
  }
  loaded_case_ = std::move(loaded_case);
  current_ = request;
  built_in_.reset();
  preparing_.reset();
}

void Trainer::update(double now_s) {
  if (loading_ && loading_->done()) take_over_loaded();
  take_over_prepared();
  if (!options_.shader_folder.empty() && now_s - shaders_looked_at_s_ > 0.5) {
    shaders_looked_at_s_ = now_s;
    reload_shaders();
  }
  notice_recordings();
  notice_sweep();
  const bool setting_up = setup() != nullptr;
  std::visit([&](auto& mode) { update(mode, now_s); }, mode_);
  // A session that a finished set-up has begun is advanced before it is drawn.
  if (setting_up && session()) std::visit([&](auto& mode) { update(mode, now_s); }, mode_);
}

const Scenario* Trainer::briefing() const {
  return scan() && !scan()->begun ? &*loaded_case_->scenario : nullptr;
}

void Trainer::brief() {
  if (session() && !session()->runner() && loaded_case_->scenario) scan()->begun = false;
}

void Trainer::start() {
  if (!briefing()) return;
  scan()->begun = true;
  if (!session()->runner()) attempt([&] { session()->start_over(); });
}

void Trainer::leave_briefing() {
  if (!briefing()) return;
  if (session()->runner()) return leave();
  scan()->begun = true;
}

void Trainer::update(SettingUp& mode, double now_s) {
  attempt([&] { mode.wizard->update(now_s); });
  if (mode.wizard->finished()) end_setup();  // which ends the mode
}

template <std::derived_from<Scan> Mode>
void Trainer::update(Mode& mode, double now_s) {
  const double since_s = now_s - std::exchange(mode.now_s, now_s);
  Session& session = *mode.session;
  if (!mode.begun && session.runner()) return;
  if (covered_ && session.can_stand_still()) {
    mode.behind_s += since_s;
    return;
  }
  if (!options_.record.empty() && !recorded_) start_recording();
  const bool had_result = session.result().has_value();
  const std::optional<std::size_t> step =
      session.runner() ? std::optional(session.runner()->live().step) : std::nullopt;
  guide_.report_use(session);
  mode.best_frames.see(session);
  session.advance(now_s - mode.behind_s);
  if (step && session.runner() && !session.result() && session.runner()->live().step != *step)
    if (std::string said = how_step_ended(*session.runner(), *step); !said.empty()) {
      if (session.machine().frozen) said += " The picture is still frozen: Space makes it live.";
      notices_.push_back({std::move(said), {}});
    }
  mode.tools.see(session);
  mode.controls.see(session);
  mode.undo.watch(session);
  if constexpr (std::is_same_v<Mode, Authoring>) mode.author.see(session);
  recorder_.take(session);
  attempt([&] { recorder_.check(); });
  attempt([&] { check_raw(); });
  if (!session.result()) result_files_.reset();
  results_due_ = results_due_ || (!had_result && session.result());
  if constexpr (std::is_same_v<Mode, Exam>) attempt([&] { keep_sitting(mode); });  // which may end the mode
}

void Trainer::draw(const PictureSizes& sizes, const Effort& effort) {
  pictures_.ct = preferences_.ct;
  try {
    if (const Replay* run = replay()) {
      Effort of_moment = effort;
      of_moment.at_rest = !run->playing();
      pictures_.update(run->moment().shown_pose, run->machine(), sizes, of_moment);
    }
    if (session()) pictures_.update(*session(), sizes, effort);
  } catch (const std::runtime_error& error) {
    // What was built when the file changed may not build for settings that come later.
    if (options_.shader_folder.empty()) throw;
    report_shader_problem(error.what());
  }
  if (!session()) return;
  if (!options_.latency.empty()) {
    glFinish();
    latency_.add(*session(), steady_now_s());
  }
  if (feed_ && !session()->strict()) feed_->publish(*session());
  show_pictures();
}

void Trainer::show_pictures() {
  const bool clients = feed_ && !session()->strict() && feed_->wants_pictures(), recording = recorder_.wants_pictures(),
             sweeping = sweep_.running();
  if ((clients && !clients_) || (recording && !records_pictures_) || (sweeping && !sweeps_)) reader_.ask_again();
  clients_ = clients;
  records_pictures_ = recording;
  sweeps_ = sweeping;
  if (!clients && !recording && !sweeping) return reader_.forget();
  reader_.ask(*session(), pictures_);
  // Without a window nobody sees a frame that takes longer, and every picture counts.
  while (const std::optional<DrawnPicture> picture = reader_.take(options_.headless)) {
    if (clients) feed_->show(*picture);
    recorder_.take(*picture);
    sweep_.take(*picture);
  }
}

void Trainer::reload_shaders() {
  const auto changed = gl::last_change(options_.shader_folder);
  if (changed == shaders_changed_) return;
  shaders_changed_ = changed;
  report_shader_problem(pictures_.reload(gl::ShaderSources(options_.shader_folder)).value_or(""));
}

void Trainer::report_shader_problem(const std::string& problem) {
  if (problem == shader_problem_) return;
  shader_problem_ = problem;
  // The screen has room for its beginning; whoever edits shaders has a terminal.
  if (!problem.empty()) std::fprintf(stderr, "insonate: %s\n", problem.c_str());
}

}  // namespace insonate
