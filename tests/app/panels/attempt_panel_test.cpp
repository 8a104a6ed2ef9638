#include "app/panels/learners/attempt_panel.h"

#include <catch2/catch.hpp>

#include "scenarios/result_json.h"
#include "sim/files/files.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;
using namespace insonate::ui;

namespace {

/// A database with one attempt, number 1, and the page that shows it.
struct Lab {
  Lab(const std::filesystem::path& file) {
    ResultsDatabase database = ResultsDatabase::open_or_make(file);
    Attempt attempt;
    attempt.learner = "L-01";
    attempt.finished_ms = 1'795'284'309'250;
    attempt.scenario_text = "exam";
    attempt.scenario_file = "/exams/exam.toml";
    ExamResult result;
    result.title = "The exam";
    attempt.score_json = to_json(result);
    attempt.trace_json = to_json(std::vector<TracePoint>());
    database.add(attempt);
    page = std::make_unique<LearnersPage>(file);
    page->choose_attempt(attempt.number);
  }
  std::unique_ptr<LearnersPage> page;
};

/// The panel in a window of its own, frame by frame.
class Desk {
public:
  Desk() : theme_((ImGui::CreateContext(), assets_folder() / "fonts")) {
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().DisplaySize = {1280, 800};
    ImGui::GetIO().DeltaTime = 0.1f;
    theme_.fit(1280, 800);
  }
  ~Desk() { ImGui::DestroyContext(); }

  void frame(LearnersPage& page) {
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({1280, 800});
    ImGui::Begin("desk", nullptr, ImGuiWindowFlags_NoDecoration);
    panel.draw(
        theme_, {20, 20, 400, 500}, page, [](const std::function<void()>& work) { work(); }, places_);
    ImGui::End();
    ImGui::Render();
  }
  void click(const std::string& place, LearnersPage& page) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = places_.at(place).centre();
    frame(page);
    io.MouseDown[0] = true;
    frame(page);
    io.MouseDown[0] = false;
    frame(page);
  }
  void type(const char* text, LearnersPage& page) {
    for (int wait = 0; wait < 5 && !panel.ready(); ++wait) frame(page);
    REQUIRE(panel.ready());
    ImGui::GetIO().AddInputCharactersUTF8(text);
    frame(page);
    frame(page);
  }

  AttemptPanel panel;

private:
  Theme theme_;
  std::map<std::string, Rect> places_;
};

}  // namespace

TEST_CASE("what is typed about an attempt is not kept with an attempt of another database that has its number") {
  const ResultsFolder folder;
  const Lab lab(folder / "lab.db"), other(folder / "other.db");
  REQUIRE(lab.page->attempt());
  REQUIRE(lab.page->attempt()->number == other.page->attempt()->number);
  Desk desk;
  desk.frame(*lab.page);
  desk.click("comment_field", *lab.page);
  desk.type("Slow down", *lab.page);

  desk.frame(*other.page);
  desk.click("add_comment", *other.page);
  CHECK(other.page->comments().empty());

  INFO("it is there again with its attempt");
  desk.frame(*lab.page);
  desk.click("add_comment", *lab.page);
  REQUIRE(lab.page->comments().size() == 1);
  CHECK(lab.page->comments().front().text == "Slow down");
}
