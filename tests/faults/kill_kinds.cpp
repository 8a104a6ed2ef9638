#include "tests/faults/kill_kinds.h"

#include <zlib.h>

#include <algorithm>
#include <map>
#include <optional>

#include "app/recording/run_recorder.h"
#include "devices/calibration/calibration.h"
#include "devices/record/raw_recorder.h"
#include "devices/record/recording_files.h"
#include "devices/record/sequence_recorder.h"
#include "devices/replay/raw_replay.h"
#include "devices/sequence/probe_samples.h"
#include "devices/sequence/sequence.h"
#include "scenarios/results/database/results_database.h"
#include "scenarios/results/export/report_files.h"
#include "sim/core/hash.h"
#include "sim/core/image.h"
#include "sim/core/input_error.h"
#include "sim/phantom/phantom.h"
#include "tests/app/session/tiny_session.h"
#include "tests/devices/numbered_reports.h"
#include "tests/devices/test_samples.h"
#include "tests/faults/kill_checks.h"
#include "tests/scenarios/results/made_attempt.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

// Results

class Attempts : public Kind {
public:
  Attempts() : Kind("attempts and comments in the database") {}

  void write(const fs::path& folder, const Promises&, const Commit& commit) override {
    ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
    const int first = int(database.attempts().size());
    for (int i = first; i < first + 6; ++i) {
      Attempt attempt = made_attempt("L-" + std::to_string(i), exam_, noise(std::uint32_t(i)));
      database.add(attempt);
      commit({i, 0});
      Comment comment;
      comment.attempt = attempt.number;
      comment.text = "on attempt " + std::to_string(i);
      database.add(comment);
      commit({i, 1});
    }
  }

  void check(const fs::path& folder, const Promises& promises) override {
    {
      ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
      database.check();
      const auto attempts = database.attempts();
      require(int(attempts.size()) >= next_of(promises), "an attempt is lost");
      for (std::size_t i = 0; i < attempts.size(); ++i) {
        require(attempts[i].learner == "L-" + std::to_string(i), "an attempt is another's");
        const Attempt kept = database.read(attempts[i].number);
        require(kept.log == noise(std::uint32_t(i)), "a log is another");
        require(!kept.comments.empty() || !promised(promises, std::int32_t(i), 1), "a comment is lost");
        require(kept.comments.empty() || kept.comments[0].text == "on attempt " + std::to_string(i),
                "a comment is another");
        require(kept.pictures.size() == 3 && kept.pictures[0].png == "best" + kept.log, "a picture is another");
      }
    }
    require(names_in(folder) == std::vector<std::string>{"results.db"}, "a log of the database is left");
  }

private:
  TinyExam exam_ = tiny_exam(0);
};

class Sittings : public Kind {
public:
  Sittings() : Kind("exams under way and handed in") {}

  void write(const fs::path& folder, const Promises&, const Commit& commit) override {
    ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
    for (const Sitting& left : database.sittings()) hand_in(database, left, commit);
    for (int i = 0; i < 2; ++i) {
      const int learner = int(database.attempts().size());
      Sitting sitting;
      sitting.learner = "L-" + std::to_string(learner);
      database.begin(sitting, part(learner, 0));
      commit({learner, 1});
      for (int more = 1; more <= 3; ++more) {
        database.add_part(sitting.number, part(learner, more));
        commit({learner, 1 + more});
      }
      hand_in(database, sitting, commit);
    }
  }

  void check(const fs::path& folder, const Promises& promises) override {
    ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
    database.check();
    std::map<std::string, std::string> logs;
    for (const AttemptSummary& attempt : database.attempts())
      require(logs.emplace(attempt.learner, database.read(attempt.number).log).second, "an exam counts twice");
    const std::vector<Sitting> sittings = database.sittings();
    require(sittings.size() <= 1, "there are two exams under way");
    for (std::int32_t learner = 0; learner < next_of(promises); ++learner) {
      const std::string id = "L-" + std::to_string(learner);
      const auto handed_in = logs.find(id);
      const bool under_way = !sittings.empty() && sittings[0].learner == id;
      require((handed_in != logs.end()) != under_way, "an exam is lost, or there twice");
      require(under_way == false || !promised(promises, learner, kFinished), "an exam that was handed in is under way");
      std::string log;
      if (under_way)
        for (const std::string& some : database.parts(sittings[0].number)) log += some;
      else
        log = handed_in->second;
      const std::int32_t parts = std::max(most(promises, learner).value_or(0), 0);
      std::string expected;
      int whole = 0;
      for (; whole < 4 && expected.size() < log.size(); ++whole) expected += part(learner, whole);
      require(log == expected && whole >= parts, "a part of an exam is lost");
    }
  }

private:
  static std::string part(int learner, int number) { return noise(std::uint32_t(100 + 10 * learner + number), 4000); }

  void hand_in(ResultsDatabase& database, const Sitting& sitting, const Commit& commit) const {
    std::string log;
    for (const std::string& some : database.parts(sitting.number)) log += some;
    Attempt attempt = made_attempt(sitting.learner, exam_, log);
    database.add(attempt, sitting.number);
    commit({std::int32_t(std::stoi(sitting.learner.substr(2))), kFinished});
  }

  TinyExam exam_ = tiny_exam(0);
};

// Recordings

constexpr int kWidth = 24, kHeight = 16;

std::string pixels_of(std::size_t index) {
  std::string pixels(kWidth * kHeight, '\0');
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = char(hash(std::uint32_t(index), std::uint32_t(i)));
  return pixels;
}

Image<std::uint8_t> picture(std::size_t index) {
  Image<std::uint8_t> made(kWidth, kHeight);
  const std::string pixels = pixels_of(index);
  std::copy(pixels.begin(), pixels.end(), made.pixels.begin());
  return made;
}

const glm::dmat4 kProbeFromPixel(0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, -3, 0.25, 0, 1);

/// Samples of a sequence file that has to be whole, with all its pictures where it has some.
std::vector<ProbeSample> whole_sequence(const fs::path& file, const std::function<std::string(std::size_t)>& pixels) {
  const std::string bytes = read_file(file);
  const Sequence sequence = parse_sequence(bytes, file.string());
  if (sequence.has_images) {
    std::string unpacked(sequence.frames.size() * kWidth * kHeight + 1, '\0');
    uLongf size = unpacked.size();
    require(sequence.image_offset + sequence.image_bytes == bytes.size(), file.string() + " is cut");
    require(uncompress(reinterpret_cast<Bytef*>(unpacked.data()), &size,
                       reinterpret_cast<const Bytef*>(bytes.data() + sequence.image_offset),
                       uLong(sequence.image_bytes)) == Z_OK &&
                size + 1 == unpacked.size(),
            file.string() + " has damaged pictures");
    for (std::size_t i = 0; pixels && i < sequence.frames.size(); ++i)
      require(unpacked.compare(i * kWidth * kHeight, kWidth * kHeight, pixels(i)) == 0, "a picture is another");
  }
  return probe_samples(sequence);
}

bool is_beginning(const std::vector<ProbeSample>& some, const std::vector<ProbeSample>& all) {
  return some.size() <= all.size() && same_bits(some, {all.begin(), all.begin() + std::ptrdiff_t(some.size())});
}

/// Finishes what a killed recording left of `file`, and returns its samples; none when nothing of it was whole.
std::vector<ProbeSample> finish_recording(const fs::path& file, const std::function<std::string(std::size_t)>& pixels) {
  if (fs::exists(working_file(file)) || fs::exists(images_file(file))) try {
      recover_recording(file);
    } catch (const InputError&) {
      require(!fs::exists(file), "a whole recording cannot be tidied");
      remove_working_files(file);  // by hand, as the sentence says
      return {};
    }
  return fs::exists(file) ? whole_sequence(file, pixels) : std::vector<ProbeSample>{};
}

void require_only_sequences(const fs::path& folder) {
  for (const std::string& name : names_in(folder)) require(name.ends_with(".mha"), name + " is left");
  require_no_temporaries(folder);
}

class Recordings : public Kind {
public:
  Recordings() : Kind("sequence recordings") {}

  void write(const fs::path& folder, const Promises& before, const Commit& commit) override {
    const std::int32_t first = next_of(folder, "scan", before);
    for (std::int32_t number = first; number < first + 3; ++number) {
      const bool pictures = number % 2 == 1;
      SequenceRecorder recorder(file(folder, number), pictures ? kWidth : 0, pictures ? kHeight : 0);
      commit({number, 0});
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        pictures ? recorder.add(samples_[i], picture(i), kProbeFromPixel) : recorder.add(samples_[i]);
        recorder.flush();
        commit({number, std::int32_t(i + 1)});
      }
      recorder.finish();
      commit({number, kFinished});
    }
  }

  void check(const fs::path& folder, const Promises& promises) override {
    age_temporaries(folder);
    // A recording that was recovered in an earlier round is whole with fewer samples.
    const fs::path note = folder / "recovered.txt";
    std::string recovered = fs::exists(note) ? read_file(note) : " ";
    for (std::int32_t number = 0, next = next_of(folder, "scan", promises); number < next; ++number) {
      const fs::path recording = file(folder, number);
      const bool there = fs::exists(recording);
      require(there || !promised(promises, number, kFinished), "a recording is lost");
      const auto found = finish_recording(recording, pixels_of);
      const std::string noted = " " + std::to_string(number) + " ";
      if (there && recovered.find(noted) == std::string::npos)
        require(found.size() == samples_.size(), "half a recording looks whole");
      else
        recovered += noted;
      require(is_beginning(found, samples_), "a sample is another");
      require(int(found.size()) >= most(promises, number).value_or(0), "a sample is lost");
    }
    fs::remove(note);
    require_only_sequences(folder);
    write_file(note, recovered);
  }

private:
  static fs::path file(const fs::path& folder, std::int32_t number) {
    return folder / ("scan-" + std::to_string(number) + ".igs.mha");
  }
  std::vector<ProbeSample> samples_ = samples_of(0.5, 60, [](double t) {
    return turned(90 * t, {1, 2, 3}, {t, 2, 3});
  });
};

class Runs : public Kind {
public:
  Runs() : Kind("the trainer's run recorder") {}

  void write(const fs::path& folder, const Promises&, const Commit& commit) override {
    Session session(loaded_case_, replay_of(samples_));
    RunRecorder recorder(true);
    recorder.start(folder / "run.igs.mha", false);
    double now_s = 0;
    for (int attempt = 0; attempt < 2; ++attempt) {
      if (attempt > 0) session.start_over();
      std::size_t count = 0;
      for (int step = 0; step < 25; ++step, now_s += 1.0 / 30) {
        session.advance(now_s);
        recorder.take(session);
        count += session.latest_samples().size();
        if (step % 3 == 0) recorder.take(drawn(session, now_s));
        if (step % 5 != 4) continue;
        recorder.wait();
        recorder.check();
        commit({number_of(recorder.file()), std::int32_t(count)});
      }
    }
    const std::int32_t number = number_of(recorder.file());
    recorder.stop();
    recorder.wait();
    recorder.check();
    commit({number, kFinished});
  }

  void check(const fs::path& folder, const Promises& promises) override {
    age_temporaries(folder);
    for (std::int32_t number = 1; number <= next_of(promises) + 2; ++number) {
      const std::string stem = "run" + (number == 1 ? "" : "-" + std::to_string(number));
      const fs::path poses = folder / (stem + ".igs.mha"), images = folder / (stem + "-images.igs.mha");
      require(fs::exists(poses) || !promised(promises, number, kFinished), "a recording is lost");
      finish_recording(images, nullptr);
      const auto found = finish_recording(poses, nullptr);
      require(is_beginning(found, samples_), "a sample is another");
      require(int(found.size()) >= most(promises, number).value_or(0), "a sample is lost");
    }
    require_only_sequences(folder);
  }

private:
  static std::int32_t number_of(const fs::path& file) {
    const std::string name = file.filename().string();
    return name == "run.igs.mha" ? 1 : std::stoi(name.substr(4));
  }
  static DrawnPicture drawn(const Session& session, double now_s) {
    DrawnPicture made;
    made.grey = picture(std::size_t(now_s * 30));
    made.geometry = {kWidth, kHeight, 120.0 / kWidth, {-60, 1}};
    made.time_s = now_s;
    made.attempt = session.attempt();
    return made;
  }
  std::shared_ptr<const LoadedCase> loaded_case_ = tiny_loaded_case();
  std::vector<ProbeSample> samples_ = searching_scan();
};

class RawRecordings : public Kind {
public:
  RawRecordings() : Kind("raw recordings") {}

  void write(const fs::path& folder, const Promises& before, const Commit& commit) override {
    const std::int32_t first = next_of(folder, "run", before);
    for (std::int32_t number = first; number < first + 3; ++number) {
      RawRecorder recorder(file(folder, number), "hydra:", Pose{});
      recorder.opened({0x1532, 0x0300, "", "", "", -1}, 0);
      commit({number, 0});
      for (int x = 1; x <= kReports; ++x) {
        recorder.came(hydra_report(x), 0.01 * x);
        if (!recorder.problem().empty()) throw InputError(recorder.problem());
        commit({number, x});
      }
    }
  }

  void check(const fs::path& folder, const Promises& promises) override {
    write_file(folder / "whole.raw", whole_text());
    const auto all = read_raw_scan(folder / "whole.raw").samples;
    fs::remove(folder / "whole.raw");
    require(int(all.size()) == kReports, "a report is not a sample");
    for (std::int32_t number = 0; number < next_of(folder, "run", promises); ++number) {
      if (!fs::exists(file(folder, number))) {
        require(!most(promises, number), "a recording is lost");
        continue;
      }
      std::vector<ProbeSample> found;
      try {
        found = read_raw_scan(file(folder, number)).samples;
      } catch (const InputError&) {
        // Nothing of it became a sample.
      }
      require(is_beginning(found, all), "a sample is another");
      require(int(found.size()) >= most(promises, number).value_or(0), "a report is lost");
    }
  }

private:
  static constexpr int kReports = 40;
  static fs::path file(const fs::path& folder, std::int32_t number) {
    return folder / ("run-" + std::to_string(number) + ".raw");
  }
  static std::string whole_text() {
    const fs::path file = fs::temp_directory_path() / ("insonate-whole-" + std::to_string(getpid()) + ".raw");
    fs::remove(file);
    {
      RawRecorder recorder(file, "hydra:", Pose{});
      recorder.opened({0x1532, 0x0300, "", "", "", -1}, 0);
      for (int x = 1; x <= kReports; ++x) recorder.came(hydra_report(x), 0.01 * x);
    }
    const std::string text = read_file(file);
    fs::remove(file);
    return text;
  }
};

}  // namespace

std::vector<std::unique_ptr<Kind>> library_kinds() {
  std::vector<std::unique_ptr<Kind>> kinds;
  kinds.push_back(std::make_unique<Attempts>());
  kinds.push_back(std::make_unique<Sittings>());
  kinds.push_back(std::make_unique<Recordings>());
  kinds.push_back(std::make_unique<Runs>());
  kinds.push_back(std::make_unique<RawRecordings>());
  add_folder_kinds(kinds);
  return kinds;
}

}  // namespace insonate
