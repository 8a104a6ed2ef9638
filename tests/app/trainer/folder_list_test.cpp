#include "app/trainer/folder_list.h"

#include <catch2/catch.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "scenarios/results/database/results_database.h"
#include "sim/files/files.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

TEST_CASE("a folder's list shows what can be opened for a purpose, folders first") {
  const ResultsFolder folder;
  for (const char* name : {"b.nii.gz", "a.toml", "run.igs.mha", "notes.txt", ".hidden.nii", "case/case.toml",
                           "Zoo/x.txt", "series/IM0001"})
    write_file(folder / name, name);
  write_file(folder / "series/IM0001", std::string(128, '\0') + "DICM");
  const auto names = [&](Wanted wanted) {
    std::string text;
    for (const FolderEntry& entry : list_folder(folder.path, wanted).entries)
      text += entry.path.filename().string() + (entry.is_folder ? "/ " : " ");
    return text;
  };
  CHECK(names(Wanted::anything) == "series/ Zoo/ a.toml b.nii.gz case run.igs.mha ");
  CHECK(names(Wanted::patient) == "series/ Zoo/ b.nii.gz case ");
  CHECK(names(Wanted::scenario) == "case/ series/ Zoo/ a.toml ");
  CHECK(names(Wanted::recording) == "case/ series/ Zoo/ run.igs.mha ");
  CHECK(names(Wanted::cases) == "case/ series/ Zoo/ ");

  CHECK(list_folder(folder / "series", Wanted::patient).is_series);
  CHECK_FALSE(list_folder(folder / "Zoo", Wanted::patient).is_series);
  CHECK_FALSE(is_plain_folder(folder / "series"));
  CHECK_FALSE(is_plain_folder(folder / "case"));
  CHECK(is_plain_folder(folder / "Zoo"));
  CHECK(list_folder(folder / "missing", Wanted::anything).problem.find("missing") != std::string::npos);
  CHECK(list_folder(folder.path, Wanted::patient).entries[2].bytes == 8);
}

TEST_CASE("a folder's list looks into no open database, whose locks would be lost") {
  const ResultsFolder folder;
  int go[2];
  REQUIRE(pipe(go) == 0);
  // Another program opens the database and closes it. If nobody else seems to have it open, it takes the log away.
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    char byte = 0;
    if (read(go[0], &byte, 1) == 1) ResultsDatabase::open(folder / "lab.db").attempts();
    _exit(0);
  }
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "lab.db");
  Attempt attempt = made_attempt("L-01", tiny_exam(0));
  database.add(attempt);
  CHECK(list_folder(folder.path, Wanted::anything).entries.empty());
  is_plain_folder(folder.path);
  REQUIRE(write(go[1], "!", 1) == 1);
  REQUIRE(waitpid(child, nullptr, 0) == child);
  for (const int end : go) close(end);
  CHECK(std::filesystem::exists(folder / "lab.db-wal"));
  CHECK(std::filesystem::exists(folder / "lab.db-shm"));
  database.check();
}

TEST_CASE("what is typed is a path from the home folder or the current one") {
  setenv("HOME", "/home/learner", 1);
  CHECK(typed_path("~/ct.nii") == "/home/learner/ct.nii");
  CHECK(typed_path("/a/b") == "/a/b");
  CHECK(typed_path("b") == std::filesystem::current_path() / "b");
  CHECK(folder_above("/a/b") == "/a");
  CHECK(folder_above("/") == "/");
}

TEST_CASE("sizes are written in the largest unit that has a whole number") {
  CHECK(size_text(999) == "999 B");
  CHECK(size_text(1'000) == "1 kB");
  CHECK(size_text(84'300'000) == "84 MB");
  CHECK(size_text(999'700'000) == "1 GB");
}
