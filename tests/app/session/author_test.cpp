// Views that are made of frozen pictures.

#include "app/session/author.h"

#include <catch2/catch.hpp>

#include "app/session/guide.h"
#include "sim/core/input_error.h"
#include "tests/app/session/tiny_session.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;

namespace {

/// An expert's hand on the tiny case, which also lies in a folder.
struct Desk {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path / "ball";
  std::vector<ProbeSample> coming;
  Session session{tiny_loaded_case(false), [this] { return std::make_unique<HandFed>(coming); }, 0};
  Author author{path};
  double now_s = 1;

  Desk() { write_case(path, tiny_case()); }

  void hold(const Pose& pose) {
    now_s += 0.1;
    coming = {{now_s, PoseStatus::ok, pose, 0}};
    session.advance(now_s);
    author.see(session);
  }
  void freeze(const Pose& pose) {
    session.freeze(false);
    hold(pose);
    hold(pose);
    session.freeze(true);
    hold(pose);
  }
  void want(const std::string& name) {
    for (std::size_t i = 0; i < author.parts().size(); ++i)
      if (author.parts()[i].name == name) return author.toggle(i);
    FAIL(name << " is not in the picture");
  }
};

std::vector<std::string> names(const std::vector<Author::Part>& parts) {
  std::vector<std::string> names;
  for (const Author::Part& part : parts) names.push_back(part.name);
  return names;
}

// Beside the ball's middle, and turned: no number is round.
const Pose kHeld = turned(7, {0.1, 1, 0.2}, {3.3, 0.4, -1.7});

}  // namespace

TEST_CASE("a frozen picture with a title and what it must show becomes a view of the case") {
  Desk desk;
  desk.hold(kHeld);
  CHECK(desk.author.parts().empty());
  desk.session.set(ActionKind::depth, 110);
  desk.freeze(kHeld);
  CHECK(names(desk.author.parts()) == std::vector<std::string>{"ball", "centre", "top"});
  CHECK_FALSE(desk.author.ready());
  desk.author.title("The ball, as we hold it");
  CHECK_FALSE(desk.author.ready());
  desk.want("ball");
  desk.want("centre");
  REQUIRE(desk.author.ready());
  desk.author.keep(desk.session);

  const Case read = read_case(desk.path);
  REQUIRE(read.views.size() == 3);
  const ReferenceView& view = read.views[2];
  CHECK(view.name == "the_ball_as_we_hold_it");
  CHECK(view.title == "The ball, as we hold it");
  CHECK(view.probe == desk.session.machine().probe);
  CHECK(view.depth_mm == 110);
  CHECK(view.targets == std::vector<std::string>{"ball"});
  CHECK(view.landmarks == std::vector<std::string>{"centre"});
  CHECK(view.patient_from_probe == kHeld);  // to the bit
  CHECK(desk.author.kept().find("'the_ball_as_we_hold_it'") != std::string::npos);

  INFO("the next one begins with nothing chosen");
  CHECK_FALSE(desk.author.ready());
  CHECK(desk.author.title().empty());
  CHECK_FALSE(desk.author.parts()[0].wanted);
}

TEST_CASE("the way to a view that was made is shown at once, behind the case's own, until the case is read again") {
  Desk desk;
  desk.freeze(kHeld);
  desk.author.title("As we hold it");
  desk.want("ball");
  Guide guide;
  const auto next = [&] {
    guide.next(desk.session);
    const std::optional<Guiding> guiding = guide.now(desk.session);
    return guiding ? guiding->view->name : "";
  };
  CHECK(next() == "ball");
  const std::optional<ReferenceView> made = desk.author.keep(desk.session);
  REQUIRE(made);
  CHECK_FALSE(desk.author.keep(desk.session));  // the next one is not ready
  guide.add(*made);
  CHECK(next() == "bare");
  CHECK(next() == "as_we_hold_it");
  const Guiding guiding = guide.now(desk.session).value();
  CHECK(guiding.there);
  CHECK(guiding.view->title == "As we hold it");
  CHECK(guiding.view->patient_from_probe == kHeld);
  CHECK(guiding.view->depth_mm == desk.session.machine().depth_mm);
  desk.session.freeze(false);
  desk.hold(turned(0, {1, 0, 0}, {0, 0, 45}));
  CHECK_FALSE(guide.now(desk.session)->there);

  INFO("where the case is read again it has the view itself");
  guide.forget_made();
  CHECK_FALSE(guide.now(desk.session));
  CHECK(next() == "ball");
  CHECK(next() == "bare");
  CHECK(next().empty());
}

TEST_CASE("what was chosen stays chosen in the next picture, and a view that is refused loses nothing") {
  Desk desk;
  desk.freeze(kHeld);
  desk.want("ball");
  desk.author.title("Ball");  // the case has a view 'ball'
  CHECK_THROWS_AS(desk.author.keep(desk.session), InputError);
  CHECK(desk.author.title() == "Ball");
  CHECK(desk.author.kept().empty());
  CHECK(read_case(desk.path).views.size() == 2);

  desk.freeze(turned(0, {1, 0, 0}, {0, 0, 45}));  // away from the ball
  CHECK(names(desk.author.parts()) == std::vector<std::string>{"rib"});
  CHECK_FALSE(desk.author.ready());
  desk.freeze(kHeld);
  CHECK(desk.author.parts()[0].wanted);
  desk.want("ball");
  CHECK_FALSE(desk.author.ready());
}

TEST_CASE("a deeper picture of the same plane shows more") {
  Desk desk;
  desk.session.set(ActionKind::depth, 30);
  desk.freeze(Pose{});
  CHECK(desk.author.parts().empty());
  desk.session.freeze(false);
  desk.session.set(ActionKind::depth, 50);
  desk.freeze(Pose{});
  CHECK(names(desk.author.parts()) == std::vector<std::string>{"ball", "top"});
}

TEST_CASE("what takes the most of the picture comes first") {
  Desk desk;
  const Pose along_z = turned(90, {0, 1, 0});
  const auto structures_at = [&](double depth_mm) {
    desk.session.freeze(false);
    desk.session.set(ActionKind::depth, depth_mm);
    desk.freeze(along_z);
    auto found = names(desk.author.parts());
    std::erase_if(found, [](const std::string& name) { return name == "centre" || name == "top"; });
    return found;
  };
  CHECK(structures_at(43) == std::vector<std::string>{"rib", "ball"});  // of the ball its nearest 3 mm
  CHECK(structures_at(120) == std::vector<std::string>{"ball", "rib"});
}

TEST_CASE("a view's name is made of its title") {
  CHECK(view_name_of("Right kidney, long axis") == "right_kidney_long_axis");
  CHECK(view_name_of("  RUQ -- 2nd try! ") == "ruq_2nd_try");
  CHECK(view_name_of("4 chambers") == "chambers");
  CHECK(view_name_of("???").empty());
}
