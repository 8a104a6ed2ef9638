#include "app/trainer/check_page.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <utility>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/volume/open_case.h"

namespace insonate {
namespace {

constexpr double kLook_s = 0.5;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    if (!lines.back().empty() && lines.back().back() == '\r') lines.back().pop_back();
    begin = end + 1;
  }
  return lines;
}

/// Returns what is being done to a variant: "Checking variant 2 of 3, with a stone: its patient".
std::string activity(std::size_t variant, const CheckedText& text) {
  if (text.on_patients.size() == 1) return "Checking it on its patient";
  const std::string& name = text.on_patients[variant].variant;
  return "Checking variant " + std::to_string(variant + 1) + " of " + std::to_string(text.on_patients.size()) +
         (name.empty() ? "" : ", " + name) + ", on its patient";
}

}  // namespace

struct CheckPage::Found {
  std::mutex mutex;
  std::vector<Mistake> problems;
  std::string failure, title;
  std::size_t steps = 0;

  void add(const std::vector<Mistake>& more) {
    const std::lock_guard lock(mutex);
    problems.insert(problems.end(), more.begin(), more.end());
  }

  void check(const std::filesystem::path& file, const std::filesystem::path& case_folder,
             const LoadProgress& progress) {
    const CheckedOn on = case_folder.empty() ? CheckedOn::its_patients : CheckedOn::given_patient;
    progress("Checking the text", 0);
    const CheckedText text = check_text(file, on);
    add(text.problems);
    if (!text.read.variants.empty()) {
      const std::lock_guard lock(mutex);
      title = text.read.variants.front().title;
      steps = text.read.variants.front().steps.size();
    }
    std::optional<Case> patient;
    std::string key;
    for (std::size_t i = 0; i < text.on_patients.size(); ++i) {
      const std::string what = activity(i, text);
      progress(what, 0);
      add(check_on_patient(text, text.on_patients[i], on, [&](const Scenario& variant) -> const Case& {
        if (patient && (on == CheckedOn::given_patient || patient_key(variant) == key)) return *patient;
        patient.reset();  // frees its memory before the next one is made
        key = patient_key(variant);
        patient = on == CheckedOn::given_patient ? open_case(case_folder)
                                                 : load_case(variant, assets_folder(), cache_folder(),
                                                             [&](double share) { progress(what, share); });
        return *patient;
      }));
    }
  }
};

CheckPage::CheckPage(std::filesystem::path file, std::filesystem::path case_folder)
    : file_(std::move(file)), case_folder_(std::move(case_folder)) {
  read();
  begin();
}

/// Reads the text, empty if there is no file.
void CheckPage::read() {
  try {
    text_ = read_file(file_);
    is_there_ = true;
  } catch (const InputError&) {
    text_.clear();
    is_there_ = false;
  }
}

void CheckPage::begin() {
  lines_ = lines_of(text_);
  problems_.clear();
  failure_.clear();
  title_.clear();
  steps_ = 0;
  ++checks_;
  found_ = std::make_shared<Found>();
  checking_ = std::make_unique<Loading>(
      [found = found_, file = file_, case_folder = case_folder_](const LoadProgress& progress) {
        try {
          found->check(file, case_folder, progress);
        } catch (const std::exception& error) {
          const std::lock_guard lock(found->mutex);
          found->failure = error.what();
        }
        return std::shared_ptr<const LoadedCase>();  // only the findings are asked for
      });
}

void CheckPage::check_again() {
  read();
  begin();
}

void CheckPage::update(double now_s) {
  if (looked_s_ < 0 || now_s - looked_s_ >= kLook_s) {
    looked_s_ = now_s;
    const std::string before = std::move(text_);
    const bool was_there = is_there_;
    read();
    if (text_ != before || is_there_ != was_there) begin();
  }
  if (checking_) take_over();
}

void CheckPage::take_over() {
  const bool done = checking_->done();
  {
    const std::lock_guard lock(found_->mutex);
    problems_ = in_order_of_file(found_->problems);
    failure_ = found_->failure;
    title_ = found_->title;
    steps_ = found_->steps;
  }
  if (done) std::exchange(checking_, nullptr)->take();
}

CheckPage::State CheckPage::state() const {
  if (checking_) return State::checking;
  return problems_.empty() && failure_.empty() ? State::right : State::wrong;
}

std::optional<Loading::Progress> CheckPage::progress() const {
  return checking_ ? std::optional(checking_->progress()) : std::nullopt;
}

std::optional<std::size_t> CheckPage::chosen() const {
  if (problems_.empty()) return std::nullopt;
  return std::min(chosen_, problems_.size() - 1);
}

void CheckPage::choose(std::size_t problem) {
  chosen_ = problem;
}

void CheckPage::move_choice(int places) {
  if (const std::optional<std::size_t> now = chosen())
    chosen_ = std::size_t(std::clamp(long(*now) + places, 0L, long(problems_.size()) - 1));
}

}  // namespace insonate
