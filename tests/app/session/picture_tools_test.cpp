#include "app/session/picture_tools.h"

#include <catch2/catch.hpp>

#include "devices/mouse/mouse_tracker.h"
#include "scenarios/caliper.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

constexpr double kReach_mm = 2;

const std::string kVolume = R"(
[[step]]
kind = "measure"
title = "Volume"
instruction = "Measure it."
view = "ball"
tool = "volume"
walls = "outer to outer"
time_limit_s = 60
[[step.target]]
structures = ["ball"]
)";
const std::string kEllipse = R"(
[[step]]
kind = "measure"
title = "Area"
instruction = "Measure it."
view = "ball"
tool = "ellipse"
walls = "outer to outer"
[[step.target]]
structures = ["ball"]
)";
const std::string kPoint =
    "[[step]]\nkind = \"mark_point\"\ntitle = \"Top\"\ninstruction = \"Point.\"\n"
    "landmark = \"top\"\n";
const std::string kLabels =
    "[[step]]\nkind = \"label_structures\"\ntitle = \"Names\"\ninstruction = \"Name.\"\n"
    "structures = [\"rib\", \"ball\"]\n";

/// A learner with the probe on the reference pose, and tools that see what they do.
struct Desk {
  std::shared_ptr<const LoadedCase> loaded_case;
  std::unique_ptr<Session> session;
  PictureTools tools;
  double now_s = 0;

  explicit Desk(const std::string& steps) {
    auto made = std::make_shared<LoadedCase>();
    made->subject = tiny_case();
    made->tissues = tiny_tissues();
    if (!steps.empty())
      made->scenario = parse_scenario(
          "format = 2\ntitle = \"Tools\"\ncase = \"tiny\"\npass_mark_percent = 50\ntime_limit_s = 600\n" + steps +
              "[[criterion]]\nmetric = \"time_s\"\nfull = 10\nzero = 100\n",
          "exam.toml");
    loaded_case = made;
    session = std::make_unique<Session>(loaded_case, [] { return std::make_unique<MouseTracker>(Pose{}); });
    pass();
  }
  /// Two samples' time.
  void pass() {
    session->advance(now_s += 1.0 / 30);
    tools.see(*session);
  }
  void freeze(bool frozen = true) {
    session->freeze(frozen);
    pass();
  }
  void slide(double z_mm) {
    session->move_probe([&](const ProbeHand&, const Pose& pose) {
      Pose moved = pose;
      moved.translation.z += z_mm;
      return moved;
    });
    pass();
  }
  void press(double x, double y) { tools.press(*session, {x, y}, kReach_mm); }
  void release(double x, double y) { tools.release(*session, {x, y}, kReach_mm); }
  void click(double x, double y) {
    press(x, y);
    release(x, y);
    pass();
  }
  /// All that the exam was handed, without the machine's settings.
  std::vector<Action> done() const {
    std::vector<Action> all;
    for (const auto& [time_s, actions] : session->actions())
      for (const Action& action : actions)
        if (action.kind >= ActionKind::caliper) all.push_back(action);
    return all;
  }
  double length(int slot) const { return caliper_length_mm(tools.annotations().measured().at(slot).action); }
  bool is_empty() const { return !tools.annotations().any() && !tools.in_hand(); }
};

}  // namespace

TEST_CASE("two clicks or one drag make a caliper, and its ends can be dragged") {
  Desk desk(kVolume);
  desk.click(0, 40);
  CHECK(desk.is_empty());  // the picture runs
  desk.freeze();
  desk.click(0, 40);
  REQUIRE(desk.tools.in_hand());
  desk.tools.move({0, 70});
  CHECK(caliper_length_mm(*desk.tools.in_hand()) == 30);
  CHECK(desk.tools.annotations().measured().empty());
  desk.click(0, 80);
  CHECK(desk.length(1) == 40);
  CHECK(desk.tools.slot() == 2);

  desk.press(-20, 60);
  desk.tools.move({0, 60});
  desk.release(20, 60);
  CHECK(desk.length(2) == 40);

  INFO("an end within reach is dragged, the other stays");
  desk.press(0.5, 79);
  desk.tools.move({0, 85});
  desk.release(0, 90);
  CHECK(desk.length(1) == 50);
  CHECK(desk.tools.annotations().measured().size() == 2);
  desk.pass();
  const std::vector<Action> expected{{ActionKind::caliper, {1, 0, 40, 0, 80}},
                                     {ActionKind::caliper, {2, -20, 60, 20, 60}},
                                     {ActionKind::caliper, {1, 0, 40, 0, 90}}};
  CHECK(desk.done() == expected);

  INFO("two clicks on one place are none");
  desk.click(50, 50);
  desk.click(50, 50.1);
  CHECK_FALSE(desk.tools.in_hand());
  CHECK(desk.done() == expected);
}

TEST_CASE("an ellipse is an axis and a width, drawn and dragged") {
  Desk desk(kEllipse);
  desk.freeze();
  CHECK(desk.tools.tool() == PictureTools::Tool::ellipse);
  desk.click(-20, 60);
  desk.click(20, 60);
  desk.tools.move({7, 65});
  CHECK(desk.tools.in_hand()->numbers[5] == Approx(5));
  desk.click(7, 70);  // beside the middle: only the distance from the axis counts
  const Action placed{ActionKind::ellipse, {1, -20, 60, 20, 60, 10}};
  CHECK(desk.done() == std::vector{placed});
  CHECK(ellipse_area_mm2(placed) == Approx(3.14159265358979 * 20 * 10));
  const std::vector<glm::dvec2> ends = handles(placed);
  REQUIRE(ends.size() == 4);
  CHECK(ends[2] == glm::dvec2(0, 50));
  CHECK(ends[3] == glm::dvec2(0, 70));
  for (const glm::dvec2& p : outline(placed, 12)) CHECK(p.x * p.x / 400 + (p.y - 60) * (p.y - 60) / 100 == Approx(1));

  desk.press(0, 50);
  desk.release(3, 45);
  desk.pass();
  CHECK(desk.done().back() == Action{ActionKind::ellipse, {1, -20, 60, 20, 60, 15}});
}

TEST_CASE("undo goes back one thing at a time, and clear takes back all, for the exam as on the screen") {
  Desk desk(kVolume);
  desk.freeze();
  desk.click(0, 40);
  CHECK(desk.tools.can_undo());
  desk.tools.undo(*desk.session);  // what is begun is given up
  CHECK(desk.is_empty());
  CHECK_FALSE(desk.tools.can_undo());

  desk.click(0, 40);
  desk.click(0, 80);
  desk.press(0, 80);
  desk.release(0, 70);
  desk.pass();
  CHECK(desk.length(1) == 30);
  desk.tools.undo(*desk.session);
  CHECK(desk.length(1) == 40);
  desk.tools.undo(*desk.session);
  CHECK(desk.is_empty());
  desk.pass();
  CHECK(desk.session->runner()->live().hold_share == 0);

  desk.click(0, 40);
  desk.click(0, 80);
  desk.click(-20, 60);
  desk.click(20, 60);
  CHECK(desk.session->runner()->live().hold_share == Approx(2 / 3.0));
  desk.tools.clear(*desk.session);
  desk.pass();
  CHECK(desk.is_empty());
  CHECK_FALSE(desk.tools.can_undo());
  CHECK(desk.session->runner()->live().hold_share == 0);
}

TEST_CASE("a step's calipers may lie in several pictures, and one that no step uses goes with its picture") {
  Desk desk(kVolume);
  desk.freeze();
  desk.click(0, 40);
  desk.click(0, 80);
  desk.freeze(false);
  CHECK(desk.tools.annotations().measured().size() == 1);
  desk.slide(5);
  desk.freeze();
  INFO("an end that lies in another picture is not taken hold of in this one");
  desk.press(0, 80);
  desk.release(30, 80);
  desk.pass();
  CHECK(desk.length(1) == 40);
  CHECK(desk.length(2) == 30);
  CHECK(desk.tools.total_text().empty());
  CHECK_FALSE(desk.tools.has_all());
  desk.click(-10, 50);
  desk.click(10, 50);
  CHECK(desk.tools.has_all());
  CHECK(desk.tools.total_text() == "Volume 13 ml");  // pi / 6 * 4 * 3 * 2 = 12.6
  CHECK(desk.session->runner()->live().counts_as_done);

  INFO("undone from another picture it is taken back, as there is no way to put it there again");
  desk.press(10, 50);
  desk.release(20, 50);
  desk.freeze(false);
  desk.tools.undo(*desk.session);
  desk.pass();
  CHECK(desk.tools.annotations().measured().size() == 2);
  CHECK_FALSE(desk.session->runner()->live().counts_as_done);

  Desk practice("");
  practice.freeze();
  practice.tools.choose(PictureTools::Tool::ellipse);
  practice.click(0, 40);
  practice.click(0, 80);
  practice.click(10, 60);
  practice.tools.choose(PictureTools::Tool::distance);
  practice.click(40, 40);
  practice.click(40, 80);
  CHECK(practice.tools.annotations().measured().at(1).action.kind == ActionKind::ellipse);
  CHECK(practice.length(2) == 40);
  CHECK_FALSE(practice.tools.has_all());
  practice.freeze(false);
  CHECK(practice.is_empty());
}

TEST_CASE("a point is clicked and dragged, and a place is clicked and then named, in no telling order") {
  Desk point(kPoint);
  point.freeze();
  CHECK_FALSE(point.tools.has_all());
  point.click(3, 45);
  CHECK(point.tools.has_all());
  point.press(3, 46);
  point.release(0, 45);
  point.pass();
  CHECK(point.done() == std::vector<Action>{{ActionKind::point, {3, 45}}, {ActionKind::point, {0, 45}}});
  CHECK(point.session->runner()->live().counts_as_done);
  point.tools.clear(*point.session);
  point.pass();
  CHECK_FALSE(point.session->runner()->live().counts_as_done);

  Desk desk(kLabels);
  desk.freeze();
  CHECK(desk.tools.names() == std::vector<std::string>{"ball", "rib"});
  desk.tools.name_place(*desk.session, "rib");  // no place yet
  CHECK(desk.is_empty());
  desk.click(0, 60);
  CHECK(desk.tools.unnamed_place());
  desk.tools.name_place(*desk.session, "rib");
  CHECK_FALSE(desk.tools.unnamed_place());
  desk.click(0, 60);  // which takes hold of the name
  CHECK_FALSE(desk.tools.unnamed_place());
  desk.click(30, 60);
  desk.tools.name_place(*desk.session, "ball");
  desk.pass();
  CHECK(desk.done() == std::vector<Action>{{ActionKind::label, {0, 60}, "rib"}, {ActionKind::label, {30, 60}, "ball"}});
  CHECK(desk.session->runner()->live().counts_as_done);
  desk.tools.undo(*desk.session);
  desk.pass();
  CHECK(desk.tools.annotations().labels().size() == 1);
  CHECK_FALSE(desk.session->runner()->live().counts_as_done);
}

TEST_CASE("another step and another attempt begin with nothing placed") {
  Desk desk(kVolume + kPoint);
  desk.freeze();
  desk.click(0, 40);
  desk.click(0, 80);
  desk.session->act({ActionKind::go_on});
  desk.pass();
  CHECK(desk.is_empty());
  CHECK(desk.tools.tool() == PictureTools::Tool::point);
  desk.click(0, 45);
  CHECK(desk.tools.annotations().point());
  desk.session->start_over();
  desk.pass();
  CHECK(desk.is_empty());
  CHECK(desk.tools.measuring());
}

TEST_CASE("a slot that the step does not ask for, as a log may have it, is named by what is placed in it") {
  Desk desk(kEllipse);
  desk.freeze();
  CHECK(desk.tools.slot_name(1) == "Area");
  for (int slot = 2; slot <= Action::kMaxSlots; ++slot) CHECK(desk.tools.slot_name(slot) == "Area");
}
