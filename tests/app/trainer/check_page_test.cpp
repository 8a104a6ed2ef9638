#include "app/trainer/check_page.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "sim/files/files.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;

namespace {

/// Returns the bundled exam on a phantom that is made in a second.
std::string coarse_exam() {
  std::string text = read_file(assets_folder() / "scenarios" / "ruq_hepatorenal.toml");
  const std::string key = "free_fluid = true\n";
  return text.insert(text.find(key) + key.size(), "voxel_mm = 4\n");
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  REQUIRE(text.find(from) != std::string::npos);
  text.replace(text.find(from), from.size(), to);
}

int line_of(const std::string& text, const std::string& words) {
  return int(1 + std::count(text.begin(), text.begin() + long(text.find(words)), '\n'));
}

/// A page whose time goes by until its check is done.
struct Shown {
  CheckPage page;
  double now_s = 0;

  void look() {
    now_s += 1;
    page.update(now_s);
    while (page.state() == CheckPage::State::checking) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      page.update(now_s);
    }
  }
};

}  // namespace

TEST_CASE("the check of a scenario finds what is wrong with its text and with its patient, each on its line") {
  const TemporaryFolder folder;
  std::string exam = coarse_exam();
  replace(exam, "view = \"hepatorenal\"", "view = \"hepatorenl\"");
  replace(exam, "pass_mark_percent", "pass_mark");
  Shown shown{CheckPage(folder.put("exam.toml", exam))};
  shown.look();
  CHECK(shown.page.state() == CheckPage::State::wrong);
  CHECK(shown.page.failure() == "");
  REQUIRE(shown.page.problems().size() >= 2);
  CHECK(std::is_sorted(shown.page.problems().begin(), shown.page.problems().end(),
                       [](const Mistake& a, const Mistake& b) { return a.place.line < b.place.line; }));
  const auto found = [&](const std::string& words) {
    return std::find_if(shown.page.problems().begin(), shown.page.problems().end(), [&](const Mistake& problem) {
      return (problem.problem + "; " + problem.remedy).find(words) != std::string::npos;
    });
  };
  REQUIRE(found("'pass_mark'") != shown.page.problems().end());
  CHECK(found("'pass_mark'")->place.line == line_of(exam, "pass_mark ="));
  REQUIRE(found("did you mean 'hepatorenal'?") != shown.page.problems().end());
  CHECK(found("did you mean 'hepatorenal'?")->place.line == line_of(exam, "\"hepatorenl\""));
  CHECK(shown.page.lines()[std::size_t(line_of(exam, "pass_mark =")) - 1].starts_with("pass_mark ="));

  shown.page.choose(0);
  shown.page.move_choice(+1);
  CHECK(shown.page.chosen() == 1);
  shown.page.move_choice(+100);
  CHECK(shown.page.chosen() == shown.page.problems().size() - 1);
}

TEST_CASE("the check of a scenario begins again when the file changes, and only then") {
  const TemporaryFolder folder;
  const std::string exam = coarse_exam();
  std::string wrong = exam;
  replace(wrong, "metric = \"plane_angle_deg\"", "metric = \"plane_angel_deg\"");
  const std::filesystem::path file = folder.put("exam.toml", wrong);
  Shown shown{CheckPage(file)};
  shown.look();
  CHECK(shown.page.state() == CheckPage::State::wrong);
  CHECK(shown.page.checks() == 1);
  shown.look();
  CHECK(shown.page.checks() == 1);

  INFO("the same length, written within the same second");
  std::string other = wrong;
  replace(other, "plane_angel_deg", "plane_angle_dag");
  folder.put("exam.toml", other);
  shown.look();
  CHECK(shown.page.checks() == 2);
  REQUIRE(!shown.page.problems().empty());
  CHECK(shown.page.problems().front().problem.find("plane_angle_dag") != std::string::npos);

  INFO("right");
  folder.put("exam.toml", exam);
  shown.look();
  CHECK(shown.page.state() == CheckPage::State::right);
  CHECK(shown.page.problems().empty());
  CHECK(shown.page.steps() > 0);
  CHECK(shown.page.title() != "");

  INFO("gone, as between the two steps of an editor's save, and there again");
  std::filesystem::remove(file);
  shown.look();
  CHECK(shown.page.state() == CheckPage::State::wrong);
  CHECK(shown.page.failure().find(file.string()) != std::string::npos);
  CHECK(shown.page.lines().empty());
  folder.put("exam.toml", exam);
  shown.look();
  CHECK(shown.page.state() == CheckPage::State::right);
  CHECK(shown.page.failure() == "");

  const long checks = shown.page.checks();
  shown.page.check_again();
  shown.look();
  CHECK(shown.page.checks() == checks + 1);
}

TEST_CASE("the check of a scenario names a patient that cannot be used") {
  const TemporaryFolder folder;
  Shown shown{CheckPage(folder.put("exam.toml", coarse_exam()), folder.path / "nobody")};
  shown.look();
  CHECK(shown.page.state() == CheckPage::State::wrong);
  CHECK(shown.page.failure().find("nobody") != std::string::npos);
}
