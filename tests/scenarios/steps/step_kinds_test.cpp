#include <catch2/catch.hpp>

#include "scenarios/report/report.h"
#include "scenarios/result_json.h"
#include "scenarios/runner.h"
#include "scenarios/steps/find_view.h"
#include "scenarios/words.h"
#include "tests/scenarios/tiny_exam.h"

using namespace insonate;

TEST_CASE("knobs are set when all of them are as asked for long enough") {
  const Scenario exam = exam_of(step(
      "set_knobs", "probe = \"linear\"\ndepth_mm = [50, 60]\ngain_db = [3, 6]\nhold_s = 0.5", "knobs_right_percent"));
  const ExamResult right =
      scored(exam, 5,
             {{1.0, {{ActionKind::probe, {}, "linear"}}}, {2.0, {{ActionKind::depth, {55}}, {ActionKind::gain, {4}}}}});
  CHECK(right.steps[0].outcome == StepOutcome::done);
  CHECK(right.steps[0].end_s == Approx(2.4).margin(0.11));
  CHECK(right.steps[0].criteria[0].points == 1);
  const ExamResult two = scored(exam, 5, {{1.0, {{ActionKind::gain, {4}}, {ActionKind::depth, {55}}}}});
  CHECK(two.steps[0].outcome == StepOutcome::scan_ended);
  CHECK(*two.steps[0].value(Metric::knobs_right_percent) == Approx(200.0 / 3));
  // Set and taken back is not set.
  const ExamResult shortly =
      scored(exam, 5,
             {{1.0, {{ActionKind::probe, {}, "linear"}, {ActionKind::gain, {4}}, {ActionKind::depth, {55}}}},
              {1.3, {{ActionKind::gain, {9}}}}});
  CHECK(shortly.steps[0].outcome == StepOutcome::scan_ended);
}

TEST_CASE("the three lengths of a volume have names, other facts their own") {
  CHECK(title_of_fact(StepResult::kLengths, "34.3 mm, 33.6 mm, 43.7 mm") == "length, depth, width");
  CHECK(title_of_fact(StepResult::kLengths, "34.3 mm, 33.6 mm") == "lengths");
  CHECK(title_of_fact(StepResult::kMeasured, "1, 2, 3") == "measured");
}

TEST_CASE("a step that asks for a view says within what limits it takes one") {
  FindView asked;
  asked.tolerance = {
      {Metric::plane_distance_mm, 8, {}}, {Metric::plane_angle_deg, 20, {}}, {Metric::target_in_view_percent, 70, {}}};
  CHECK(asked.words().prompt ==
        "The view is taken as it is, also in motion, after 1 s within 8 mm and 20\u00b0 of the asked plane, target in "
        "the picture at "
        "least 70 %.");
  asked.hold_s = 1.5;
  asked.tolerance = {{Metric::in_plane_offset_mm, 12.5, {}}};
  CHECK(asked.words().prompt ==
        "The view is taken as it is, also in motion, after 1.5 s, shift of the target within the picture at most 12.5 "
        "mm.");
}

TEST_CASE("a distance is measured between calipers in a frozen picture, against the label map") {
  const Scenario exam =
      exam_of(step("measure",
                   "view = \"ball\"\ntool = \"distance\"\nwalls = \"outer to outer\"\n[[step.target]]\n"
                   "structures = [\"ball\"]\nthrough = \"centre\"\nalong = \"lateral\"",
                   "measurement_error_mm", "full = 2\nzero = 10"));
  const auto measured = [&](double half_mm) {
    return scored(exam, 3, {{1.0, {kFreeze}}, {1.5, {caliper(1, -half_mm, 60, half_mm, 60)}}, {2.0, {kGoOn}}}).steps[0];
  };
  const StepResult right = measured(20);
  CHECK(right.outcome == StepOutcome::done);
  // The ball's diameter is 40 mm and its voxels are 2 mm wide: an edge may lie a voxel off at either end.
  CHECK(*right.value(Metric::measurement_error_mm) < 2.01);
  CHECK(*right.value(Metric::measurement_offset_mm) < 1);
  CHECK(right.criteria[0].points == Approx(1).margin(0.01));
  CHECK(*right.judged_from_s == Approx(1.5));
  CHECK(right.judged->plane_distance_mm == Approx(0).margin(1e-9));
  CHECK(*measured(17).value(Metric::measurement_error_mm) ==
        Approx(*right.value(Metric::measurement_error_mm) + 6).margin(4.01));
  double last = 2;
  for (const double half : {20.0, 22.0, 24.0, 26.0}) {
    const double points = measured(half).criteria[0].points;
    CHECK(points <= last);
    last = points;
  }
  CHECK(last == 0);

  const ExamResult running = scored(exam, 3, {{1.5, {caliper(1, -20, 60, 20, 60)}}, {2.0, {kGoOn}}});
  CHECK(running.steps[0].outcome == StepOutcome::went_on);
  CHECK(running.steps[0].criteria[0].points == 0);
  CHECK(running.steps[0].criteria[0].why == "nothing was measured in a frozen picture.");
  // Of a slot the last caliper counts, and another slot's does not.
  const ExamResult moved = scored(exam, 3,
                                  {{1.0, {kFreeze}},
                                   {1.2, {caliper(1, -5, 60, 5, 60), caliper(2, -5, 60, 5, 60)}},
                                   {1.5, {caliper(1, -20, 60, 20, 60)}},
                                   {2.0, {kGoOn}}});
  CHECK(*moved.steps[0].value(Metric::measurement_error_mm) == *right.value(Metric::measurement_error_mm));
}

TEST_CASE("what is measured in a frozen picture is judged as it was acquired, whatever a log says of the depth since") {
  const Scenario exam =
      exam_of(step("measure",
                   "view = \"ball\"\ntool = \"distance\"\nwalls = \"outer to outer\"\n[[step.target]]\n"
                   "structures = [\"ball\"]",
                   "depth_use_percent"));
  const auto judged = [&](const std::vector<Action>& before, const std::vector<Action>& since) {
    std::vector<Action> placed = since;
    placed.push_back(caliper(1, -20, 60, 20, 60));
    return to_json(scored(exam, 3, {{0.5, before}, {1.0, {kFreeze}}, {1.5, placed}, {2.0, {kGoOn}}}));
  };
  const Action deep{ActionKind::depth, {200}};
  CHECK(judged({}, {}) != judged({deep}, {}));
  CHECK(judged({}, {}) == judged({}, {deep}));
  CHECK(judged({}, {}) == judged({}, {{ActionKind::probe, {}, "linear"}, {ActionKind::frequency, {9}}}));
  CHECK(judged({}, {}) == judged({}, {{ActionKind::gain, {9}}}));
}

TEST_CASE("what is taken back was never placed") {
  const std::string measure =
      "view = \"ball\"\ntool = \"volume\"\nwalls = \"outer\"\n[[step.target]]\nstructures = [\"ball\"]\n";
  const Scenario exam = exam_of(step("measure", measure, "measurement_error_percent", "full = 5\nzero = 50"));
  const Action back{ActionKind::take_back, {2}}, slide{ActionKind::unfreeze};
  const std::vector<Action> all{caliper(1, 0, 40, 0, 80), caliper(3, -20, 60, 20, 60), caliper(2, -20, 60, 20, 60)};
  const auto pose = [](double t) { return at_z(t < 1.55 ? 0 : 8); };
  const auto judged = [&](const std::vector<Action>& later) {
    return scored(exam, 4, {{1.0, {kFreeze}}, {1.5, all}, {1.6, {slide}}, {2.0, later}, {2.5, {kGoOn}}}, pose);
  };
  CHECK(judged({}).steps[0].outcome == StepOutcome::done);
  CHECK(judged({back}).steps[0].outcome == StepOutcome::went_on);
  CHECK(judged({back}).steps[0].judged);
  CHECK(judged({back, kFreeze, caliper(2, -20, 60, 20, 60)}).steps[0].outcome == StepOutcome::done);
  INFO("judged is the picture of what is left and was placed last");
  const std::vector<Action> moved{kFreeze, caliper(2, -20, 60, 20, 60)};
  CHECK(judged(moved).steps[0].judged->plane_distance_mm == Approx(-8).margin(1e-9));
  CHECK(judged({moved[0], moved[1], back}).steps[0].judged->plane_distance_mm == Approx(0).margin(1e-9));

  const Action taken{ActionKind::take_back}, ball{ActionKind::take_back, {}, "ball"};
  const Scenario point = exam_of(step("mark_point", "landmark = \"top\"", "point_error_mm", "full = 2\nzero = 20"));
  const Action top{ActionKind::point, {0, 45}};
  CHECK(scored(point, 3, {{1.0, {top, ball}}, {2.0, {kGoOn}}}).steps[0].outcome == StepOutcome::done);
  CHECK(scored(point, 3, {{1.0, {top, taken}}, {2.0, {kGoOn}}}).steps[0].outcome == StepOutcome::went_on);
  const Scenario names = exam_of(step("label_structures", "structures = [\"ball\"]", "labels_right_percent"));
  const Action label{ActionKind::label, {0, 60}, "ball"};
  CHECK(scored(names, 3, {{1.0, {label, taken}}, {2.0, {kGoOn}}}).steps[0].outcome == StepOutcome::done);
  CHECK(scored(names, 3, {{1.0, {label, ball}}, {2.0, {kGoOn}}}).steps[0].outcome == StepOutcome::went_on);
}

TEST_CASE("a measurement that is not complete has its lengths and its reason, and no word of holding a view") {
  const Scenario exam = exam_of(step("measure",
                                     "view = \"ball\"\ntool = \"volume\"\nwalls = \"outer\"\n[[step.target]]\n"
                                     "structures = [\"ball\"]",
                                     "measurement_error_percent", "full = 5\nzero = 50"));
  const auto measured = [&](const std::vector<Action>& placed) {
    return scored(exam, 3, {{1.0, {kFreeze}}, {1.5, placed}, {2.0, {kGoOn}}});
  };
  const Action depth = caliper(1, 0, 40, 0, 80), width = caliper(3, -20, 60, 10, 60);
  const ExamResult two = measured({depth, width});
  CHECK(two.steps[0].criteria[0].why == "only 2 of 3 lengths were measured.");
  CHECK(two.steps[0].facts == std::vector<std::pair<std::string, std::string>>{{"lengths", "40.0 mm, 30.0 mm"}});
  CHECK(measured({}).steps[0].criteria[0].why == "nothing was measured in a frozen picture.");
  CHECK(measured({depth, caliper(2, -20, 60, 20, 60), width}).steps[0].facts[0].second == "40.0 mm, 40.0 mm, 30.0 mm");

  ReportSubject subject;
  subject.pictures = {{0, ReportPicture::Kind::reference, "ref"}};
  const std::string html = report_html(result_from_json(to_json(two), "x"), {}, subject);
  const std::string body = html.substr(html.find("<body>"));
  CHECK(body.find("<td>lengths</td><td>40.0\u00a0mm, 30.0\u00a0mm</td>") != std::string::npos);
  CHECK(body.find("The picture at 1.5 s was judged.") != std::string::npos);
  CHECK(body.find("held") == std::string::npos);
}

TEST_CASE("a later step knows what was measured before, and not what is true") {
  const Scenario exam =
      exam_of(step("measure",
                   "view = \"ball\"\ntool = \"ellipse\"\nwalls = \"outer\"\n[[step.target]]\nstructures = [\"ball\"]",
                   "measurement_error_percent", "full = 5\nzero = 50") +
              step("question", "choices = [\"yes\", \"no\"]\nright = \"no\"", "answer_right_percent"));
  Runner runner(exam, shared_case(), tiny_tissues());
  runner.feed(samples_of(3, 10, [](double) { return at_z(0); }),
              {{1.0, {kFreeze}}, {1.5, {{ActionKind::ellipse, {1, -20, 60, 20, 60, 20}}}}, {2.0, {kGoOn}}});
  REQUIRE(runner.live().step == 1);
  CHECK(runner.live().measured == std::vector<std::string>{"12.57 cm\u00b2 in 'A step'"});
}

TEST_CASE("areas, ratios and volumes are measured against the label map") {
  const std::string target = "[[step.target]]\nstructures = [\"ball\"]\n";
  const auto relative_error = [&](const std::string& tool, const std::string& targets,
                                  const std::vector<Action>& placed) {
    const Scenario exam =
        exam_of(step("measure", "view = \"ball\"\ntool = \"" + tool + "\"\nwalls = \"outer\"\n" + targets,
                     "measurement_error_percent", "full = 5\nzero = 50"));
    return *scored(exam, 3, {{1.0, {kFreeze}}, {1.5, placed}, {2.0, {kGoOn}}})
                .steps[0]
                .value(Metric::measurement_error_percent);
  };
  // A disc of 20 mm radius in pixels of 2 mm: the sum of voxels is known to a few per cent.
  CHECK(relative_error("ellipse", target, {{ActionKind::ellipse, {1, -20, 60, 20, 60, 20}}}) < 4);
  CHECK(relative_error("ellipse", target, {{ActionKind::ellipse, {1, -20, 60, 20, 60, 10}}}) == Approx(50).margin(2));
  CHECK(relative_error("ratio", target + "along = \"depth\"\n" + target + "along = \"lateral\"\n",
                       {caliper(1, 0, 40, 0, 80), caliper(2, -20, 60, 20, 60)}) < 0.01);
  CHECK(relative_error("volume", target,
                       {caliper(1, 0, 40, 0, 80), caliper(2, -20, 60, 20, 60), caliper(3, -20, 60, 20, 60)}) < 3);
  CHECK(relative_error("volume", target,
                       {caliper(1, 0, 40, 0, 80), caliper(2, -20, 60, 20, 60), caliper(3, -10, 60, 10, 60)}) ==
        Approx(50).margin(2));
}

TEST_CASE("a point's error is its distance in space from the landmark or the structure") {
  const auto error = [](const std::string& goal, double x, double y, double z) {
    const Scenario exam = exam_of(step("mark_point", goal, "point_error_mm", "full = 2\nzero = 20"));
    const ExamResult result = scored(exam, 3, {{1.0, {kFreeze}}, {1.5, {{ActionKind::point, {x, y}}}}, {2.0, {kGoOn}}},
                                     [&](double) { return at_z(z); });
    return *result.steps[0].value(Metric::point_error_mm);
  };
  CHECK(error("landmark = \"top\"", 3, 45, 4) == Approx(5));
  CHECK(error("structures = [\"ball\"]", 0, 60, 10) == 0);
  CHECK(error("structures = [\"ball\"]", 32, 60, 0) == Approx(12).margin(1e-6));  // the outermost voxel lies at 20
  const Scenario exam = exam_of(step("mark_point", "landmark = \"top\"", "point_error_mm", "full = 2\nzero = 20"));
  CHECK(scored(exam, 3, {{2.0, {kGoOn}}}).steps[0].criteria[0].why == "nothing was pointed at.");
}

TEST_CASE("names belong on their structures") {
  const Scenario exam =
      exam_of(step("label_structures", "structures = [\"ball\", \"rib\"]\ntolerance_mm = 3", "labels_right_percent"));
  const auto named = [](const char* name, double x, double y) { return Action{ActionKind::label, {x, y}, name}; };
  const auto right = [&](const std::vector<Action>& labels) {
    return *scored(exam, 3, {{1.0, labels}, {2.0, {kGoOn}}}, [](double) { return at_z(24); })
                .steps[0]
                .value(Metric::labels_right_percent);
  };
  // The rib begins 1 to 2 mm beside this plane, the ball's nearest voxel is 4 mm away.
  CHECK(right({named("rib", 0, 16)}) == 50);
  CHECK(right({named("rib", 0, 16), named("ball", 0, 60)}) == 50);
  CHECK(right({named("ball", 0, 16), named("rib", 0, 60)}) == 0);
  CHECK(right({named("rib", 0, 60), named("rib", 0, 16)}) == 50);
  CHECK(right({named("liver", 0, 16)}) == 0);
}

TEST_CASE("the first answer counts, and what is right may be what the patient has") {
  const std::string finding =
      "choices = [\"yes\", \"no\"]\nfinding = [\"ball\"]\nif_present = \"yes\"\nif_absent = \"no\"";
  const Scenario exam = exam_of(step("question", finding, "answer_right_percent"));
  const ExamResult yes = scored(exam, 3, {{1.0, {answer("yes"), answer("no")}}});
  CHECK(yes.steps[0].outcome == StepOutcome::done);
  CHECK(yes.steps[0].end_s == Approx(1));
  CHECK(yes.steps[0].criteria[0].points == 1);
  CHECK(yes.steps[0].facts[0] == std::pair<std::string, std::string>("answer", "yes"));
  CHECK(scored(exam, 3, {{1.0, {answer("no")}}}).steps[0].criteria[0].points == 0);
  CHECK(scored(exam, 3, {}).steps[0].criteria[0].why == "there was no answer.");

  Case without = shared_case();
  for (std::uint8_t& label : without.labels.voxels) label = label == 1 ? 0 : label;
  without.views.clear();
  Runner runner(exam, without, tiny_tissues());
  runner.feed(samples_of(2, 10, [](double) { return at_z(0); }), {{1.0, {answer("no")}}});
  CHECK(runner.result().points == 1);

  const Scenario number = exam_of(
      step("question", "answer = \"number\"\nright_number = 30\nwithin = 2", "answer_error", "full = 0\nzero = 10"));
  const auto off = [&](const char* text) { return scored(number, 3, {{1.0, {answer(text)}}}).steps[0]; };
  CHECK(*off(" 32 ").value(Metric::answer_right_percent) == 100);
  CHECK(*off("32.5").value(Metric::answer_right_percent) == 0);
  CHECK(off("32.5").criteria[0].points == Approx(0.75));
  CHECK_FALSE(off("thirty").value(Metric::answer_error));
  CHECK(off("thirty").criteria[0].why == "the answer is not a number.");

  const Scenario text =
      exam_of(step("question", "answer = \"text\"") + step("free_scan", "", "time_s", "full = 1\nzero = 9"));
  const ExamResult written = scored(text, 3, {{1.0, {answer("a large ball")}}, {2.0, {kGoOn}}});
  CHECK(written.steps[0].facts[0].second == "a large ball");
  CHECK(written.steps[1].outcome == StepOutcome::done);
}

TEST_CASE("a sweep covers the share of the organ that was in the slice and reached by the sound") {
  const Scenario exam = exam_of(step("sweep", "organ = [\"ball\"]\nkeep = [\"centre\"]", "coverage_percent"));
  const auto swept = [&](double from, double to, double rate_hz, double depth_mm = 140) {
    Runner runner(exam, shared_case(), tiny_tissues());
    const ActionLog depth{{0.0, {{ActionKind::depth, {depth_mm}}}}, {5.0, {kGoOn}}};
    runner.feed(samples_of(6, rate_hz, [&](double t) { return at_z(from + (to - from) * std::min(t / 4, 1.0)); }),
                depth);
    runner.end();
    return runner.result().steps[0];
  };
  const StepResult whole = swept(-24, 24, 40);
  CHECK(*whole.value(Metric::coverage_percent) > 99);
  CHECK(whole.outcome == StepOutcome::done);
  // Up to the middle: half of the ball, and what the slice's half thickness of 2.5 mm adds at its widest,
  // 2.5 * pi 20^2 of 4/3 pi 20^3, 9 %; cells of 4 mm make it up to one layer more or less.
  CHECK(*swept(-24, 0, 40).value(Metric::coverage_percent) == Approx(59).margin(8));
  CHECK(*swept(-24, 0, 40).value(Metric::coverage_percent) ==
        Approx(*swept(-24, 0, 200).value(Metric::coverage_percent)).margin(1));
  CHECK(*swept(-24, 24, 40, 60).value(Metric::coverage_percent) == Approx(50).margin(8));  // as deep as its middle
  CHECK(*swept(30, 60, 40).value(Metric::coverage_percent) == 0);
  // The landmark is in the picture within 5 mm: over 10 mm at 12 mm/s.
  CHECK(*whole.value(Metric::kept_in_view_percent) == Approx(100 * 10.0 / 12 / whole.end_s).margin(2));

  // More of the organ never earns less.
  double last = -1;
  for (const double to : {-20.0, -10.0, 0.0, 10.0, 20.0}) {
    const double points = swept(-24, to, 40).criteria[0].points;
    CHECK(points >= last);
    last = points;
  }
}

TEST_CASE("a sweep is done at the share asked for, and a frozen picture covers nothing") {
  const Scenario exam = exam_of(step("sweep", "organ = [\"ball\"]\ncoverage_percent = 40", "coverage_percent"));
  const auto slide = [](double t) { return at_z(-24 + 12 * t); };
  const ExamResult done = scored(exam, 6, {}, slide);
  CHECK(done.steps[0].outcome == StepOutcome::done);
  CHECK(done.steps[0].end_s < 2.5);
  const ExamResult frozen = scored(exam, 6, {{0.0, {kFreeze}}}, slide);
  CHECK(*frozen.steps[0].value(Metric::coverage_percent) == 0);
}

TEST_CASE("hints cost what the difficulty asks for, and no more than the step earned") {
  const auto points = [](const std::string& difficulty, int hints) {
    const Scenario exam = exam_of(step("question", "choices = [\"a\", \"b\"]\nright = \"a\"", "answer_right_percent",
                                       "full = 100\nzero = 0\nweight = 4") +
                                      "[[step.hint]]\ntext = \"first\"\ncost = [0, 1, 3]\n[[step.hint]]\ntext = "
                                      "\"second\"\ncost = 2\n",
                                  difficulty);
    std::vector<Action> actions(std::size_t(hints), Action{ActionKind::hint});
    actions.push_back(answer("a"));
    return scored(exam, 3, {{1.0, actions}});
  };
  CHECK(points("", 0).points == 4);
  CHECK(points("difficulty = \"easy\"\n", 1).points == 4);
  CHECK(points("", 1).points == 3);
  CHECK(points("difficulty = \"hard\"\n", 1).points == 1);
  CHECK(points("", 2).points == 1);
  CHECK(points("", 9).steps[0].hints_taken == 2);
  CHECK(points("difficulty = \"hard\"\n", 2).points == 0);
  CHECK(points("", 2).points_possible == 4);
}

TEST_CASE("warm-ups are marked, earn nothing, and the exam's time and motion begin behind them") {
  const Scenario exam =
      exam_of(step("question", "counts = false\nchoices = [\"a\", \"b\"]\nright = \"a\"", "answer_right_percent") +
              step("free_scan", "", "time_s", "full = 1\nzero = 9"));
  const ExamResult result =
      scored(exam, 30, {{10.0, {answer("b")}}, {15.0, {kGoOn}}}, [](double t) { return at_z(t); });
  CHECK(result.steps[0].criteria[0].points == 0);
  CHECK(result.points_possible == 1);
  CHECK(result.motion.time_s == Approx(5));
  // From 10 s to the last sample before going on, at 14.9 s.
  CHECK(result.motion.path_length_mm == Approx(4.9));
  CHECK(result.points == Approx(0.5));
}

TEST_CASE("an exam goes on by what a step came to, and what it leaves out does not count") {
  const std::string question = "choices = [\"a\", \"b\"]\nright = \"a\"";
  const Scenario exam = exam_of(step("question", "name = \"first\"\n" + question, "answer_right_percent") +
                                "[step.next]\npoor = \"last\"\n" + step("question", question, "answer_right_percent") +
                                step("question", "name = \"last\"\n" + question, "answer_right_percent"));
  const ExamResult good = scored(exam, 5, {{1.0, {answer("a")}}, {2.0, {answer("a")}}, {3.0, {answer("b")}}});
  CHECK(good.points == 2);
  CHECK(good.points_possible == 3);
  const ExamResult poor = scored(exam, 5, {{1.0, {answer("b")}}, {2.0, {answer("a")}}, {3.0, {answer("a")}}});
  CHECK(poor.steps[1].outcome == StepOutcome::skipped);
  CHECK(poor.points == 1);
  CHECK(poor.points_possible == 2);
  CHECK(poor.motion.time_s == Approx(2));
}

TEST_CASE("where the order is free the learner turns to any step, and a step's limit counts all visits") {
  const std::string question = "choices = [\"a\", \"b\"]\nright = \"a\"\ntime_limit_s = 3";
  const Scenario exam = exam_of(step("question", "name = \"one\"\n" + question, "answer_right_percent") +
                                    step("question", "name = \"two\"\n" + question, "answer_right_percent"),
                                "order = \"free\"\n");
  const auto go_to = [](const char* name) { return Action{ActionKind::go_to, {}, name}; };
  const ExamResult result = scored(exam, 9, {{2.0, {go_to("two")}}, {3.0, {answer("a")}}});
  CHECK(result.steps[1].start_s == 2);
  CHECK(result.steps[1].criteria[0].points == 1);
  CHECK(result.steps[0].start_s == 0);
  CHECK(result.steps[0].motion.time_s == 3);
  CHECK(result.steps[0].outcome == StepOutcome::timed_out);
  CHECK(result.steps[0].end_s == 4);  // two of its three seconds were spent before
  // In a fixed order there is no turning.
  const Scenario fixed_order = exam_of(step("question", "name = \"one\"\n" + question, "answer_right_percent") +
                                       step("question", "name = \"two\"\n" + question, "answer_right_percent"));
  CHECK(scored(fixed_order, 9, {{2.0, {go_to("two"), answer("a")}}}).steps[0].criteria[0].points == 1);
}

TEST_CASE("who turns away from a step and comes back has made its way and taken its time all the same") {
  const Scenario exam =
      exam_of(step("free_scan", "name = \"one\"", "path_length_mm", "full = 10\nzero = 100") +
                  step("question", "name = \"two\"\nchoices = [\"a\", \"b\"]\nright = \"a\"", "answer_right_percent"),
              "order = \"free\"\n");
  const auto go_to = [](const char* name) { return Action{ActionKind::go_to, {}, name}; };
  const auto to_and_fro = [](double t) { return at_z(20 * std::sin(3 * t)); };
  const auto scan = [&](ActionLog actions) {
    actions[5.0].push_back(kGoOn);
    return scored(exam, 6, actions, to_and_fro).steps[0];
  };
  const StepResult straight = scan({}), detour = scan({{4.0, {go_to("two"), go_to("one")}}});
  CHECK(detour.start_s == straight.start_s);
  CHECK(detour.motion.time_s == Approx(straight.motion.time_s));
  // What lies between the sample before a turn and the one behind it is not a step's: at most 60 mm/s for 0.1 s.
  CHECK(detour.motion.path_length_mm == Approx(straight.motion.path_length_mm).margin(6));
  CHECK(detour.motion.tracked_s == Approx(straight.motion.tracked_s));
  CHECK(detour.criteria[0].points == Approx(straight.criteria[0].points).margin(1e-9));
  REQUIRE(straight.motion.log_dimensionless_jerk);
  CHECK(*detour.motion.log_dimensionless_jerk <= *straight.motion.log_dimensionless_jerk + 1);
}

TEST_CASE("a seed draws a variant, which spells out the steps and is kept in the result") {
  const std::string text =
      "[[variant]]\nname = \"ball\"\nwords = { what = \"ball\", right = \"a\" }\n[[variant]]\nname = "
      "\"rib\"\nwords = { what = \"rib\", right = \"b\" }\n";
  const std::string steps = step("mark_point", "structures = [\"${what}\"]", "point_error_mm", "full = 2\nzero = 20") +
                            step("question", "choices = [\"a\", \"b\"]\nright = \"${right}\"", "answer_right_percent");
  std::map<std::string, int> drawn;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Scenario exam = exam_of(steps + text, "", seed);
    ++drawn[exam.variant];
    CHECK(exam.variants == 2);
    const ExamResult result = scored(exam, 3, {{0.5, {kGoOn}}, {1.0, {answer(exam.variant == "rib" ? "b" : "a")}}});
    CHECK(result.steps[1].criteria[0].points == 1);
    CHECK(result.provenance.seed == seed);
    CHECK(result_from_json(to_json(result), "x").provenance.variant == exam.variant);
  }
  // Forty fair draws leave 9 or fewer to one side once in two thousand times; these seeds do not.
  CHECK(drawn["ball"] > 9);
  CHECK(drawn["rib"] > 9);
}

TEST_CASE("the result of every kind of step is read back from its JSON") {
  const Scenario exam = exam_of(step("set_knobs", "gain_db = [1, 2]", "knobs_right_percent") +
                                step("sweep", "organ = [\"ball\"]", "coverage_percent") +
                                step("question", "choices = [\"a\", \"b\"]\nright = \"a\"", "answer_right_percent"));
  const ExamResult result = scored(exam, 9, {{1.0, {kGoOn}}, {2.0, {kGoOn}}, {3.0, {answer("b \"quoted\"")}}});
  CHECK(to_json(result_from_json(to_json(result), "x")) == to_json(result));
}
