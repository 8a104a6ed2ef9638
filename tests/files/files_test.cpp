#include "sim/files/files.h"

#include <catch2/catch.hpp>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <barrier>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/input_error.h"
#include "sim/files/held_files.h"
#include "sim/files/new_folder.h"
#include "sim/files/png.h"
#include "tests/core/system_faults.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

std::string why_unreadable(const fs::path& file) {
  try {
    read_file(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::ptrdiff_t entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

}  // namespace

TEST_CASE("what cannot be read is named in one sentence") {
  const TemporaryFolder folder;
  CHECK(why_unreadable(folder.path / "none").find("there is no such file") != std::string::npos);
  CHECK(why_unreadable(folder.path).find("this is a folder") != std::string::npos);
  std::ofstream(folder.path / "empty").close();
  CHECK(why_unreadable(folder.path / "empty").find("the file is empty") != std::string::npos);
  CHECK(why_unreadable("/dev/null").find("not an ordinary file") != std::string::npos);
  CHECK_THAT(why_unreadable(kShorterThanItClaims),
             Catch::StartsWith(kShorterThanItClaims) && Catch::Contains(": it cannot be read; check its permissions."));
  CHECK(why_unreadable(kUnreadable).find("it cannot be read (Invalid argument)") != std::string::npos);
  write_file(folder.path / "long", std::string(100, 'x'));
  const auto why_not_opened = [&] {
    const NoFilesToOpen limit;
    return why_unreadable(folder.path / "long");
  };
  CHECK(why_not_opened().find("long: it cannot be read (Too many open files)") != std::string::npos);
  CHECK_THROWS_AS(read_file(folder.path / "long", 99), InputError);
  CHECK(read_file(folder.path / "long", 100).size() == 100);
}

TEST_CASE("a write that fails leaves the old file and nothing beside it") {
  const TemporaryFolder folder;
  const fs::path file = folder.path / "deep" / "result.txt";
  write_file(file, "old");
  CHECK_THROWS(write_atomically(file, [](const fs::path& temporary) {
    std::ofstream(temporary) << "half";
    throw std::runtime_error("the disk is full");
  }));
  CHECK(read_file(file) == "old");
  CHECK(entries(file.parent_path()) == 1);
  write_file(file, "new");
  CHECK(read_file(file) == "new");
  CHECK_THROWS_WITH(write_file(file.parent_path(), "in the place of a folder"),
                    Catch::Contains("deep: it cannot be written (Is a directory); name a file"));
  CHECK(entries(folder.path) == 1);
  {
    const NoFilesToOpen limit;
    CHECK_THROWS_WITH(write_file(file, "newer"), Catch::Contains("result.txt: it cannot be written (Too many open "
                                                                 "files); check the folder's permissions"));
  }
  CHECK(read_file(file) == "new");
}

TEST_CASE("a program without its assets says so, and how to name them") {
  const TemporaryFolder folder;
  REQUIRE(fs::is_directory(assets_folder()));
  // Where the program's own folder cannot be seen: behind another root.
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    unsetenv("INSONATE_ASSETS");
    if (chdir(folder.path.c_str()) != 0 || (chroot(".") != 0 && (unshare(CLONE_NEWUSER) != 0 || chroot(".") != 0)))
      _exit(2);
    try {
      assets_folder();
    } catch (const InputError& error) {
      const std::string_view said = error.what();
      _exit(said.ends_with("share/insonate: the bundled assets are not there; install Insonate again, or set "
                           "INSONATE_ASSETS to their folder.")
                ? 0
                : 3);
    }
    _exit(1);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 2)
    WARN("this system gives nobody but root a root folder of their own");
  else
    CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("a file that is written beside another has a name that the other's next write knows") {
  const TemporaryFolder folder;
  const fs::path file = folder.path / "manifest.json", beside = write_beside(file, "text");
  CHECK(read_file(beside) == "text");
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
  fs::last_write_time(beside, fs::file_time_type::clock::now() - std::chrono::hours(48));
  remove_old_temporaries(file);
  CHECK(fs::is_empty(folder.path));
  CHECK_THROWS_WITH(write_beside(folder.path / "none" / "manifest.json", "text"),
                    Catch::Contains("none/manifest.json: it cannot be written"));
}

TEST_CASE("what killed programs left of a file goes with its next write once it is a day old, and nothing else does") {
  const TemporaryFolder folder;
  const auto put = [&](const char* name, int hours) {
    std::ofstream(folder.path / name) << "left";
    fs::last_write_time(folder.path / name, fs::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  put(".score.0123456789abcdef.partial.json", 48);
  for (const char* name : {".score.12.partial.json", "score.12.partial.json", ".score.12.partial.csv",
                           ".other.12.partial.json", ".score.x.partial.json", ".score..partial.json"})
    put(name, 48);
  put(".score.13.partial.json", 1);
  write_file(folder.path / "score.json", "{}");
  CHECK_FALSE(fs::exists(folder.path / ".score.0123456789abcdef.partial.json"));
  CHECK_FALSE(fs::exists(folder.path / ".score.12.partial.json"));  // as earlier versions named it
  CHECK(fs::exists(folder.path / ".score.13.partial.json"));
  CHECK(entries(folder.path) == 7);
}

TEST_CASE("threads that write the same file at once do not write into each other's temporary file") {
  constexpr int kThreads = 4;
  const TemporaryFolder folder;
  const fs::path file = folder.path / "score.json";
  std::barrier all_write(kThreads);
  std::vector<std::future<void>> threads;
  for (int thread = 0; thread < kThreads; ++thread)
    threads.push_back(std::async(std::launch::async, [&, thread] {
      write_atomically(file, [&](const fs::path& temporary) {
        std::ofstream(temporary) << std::string(100, char('a' + thread));
        all_write.arrive_and_wait();
      });
    }));
  for (std::future<void>& thread : threads) CHECK_NOTHROW(thread.get());
  const std::string text = read_file(file);
  CHECK(text == std::string(100, text.front()));
  CHECK(entries(folder.path) == 1);
}

TEST_CASE("a new folder appears as a whole or not at all, and takes nobody's place") {
  const TemporaryFolder folder;
  const fs::path made = folder.path / "above" / "made";
  write_folder(made, [&](const fs::path& temporary) {
    CHECK_FALSE(fs::exists(made));
    write_file(temporary / "a", "x");
  });
  CHECK(read_file(made / "a") == "x");
  CHECK(entries(made.parent_path()) == 1);
  const auto other = [](const fs::path& temporary) { write_file(temporary / "b", "y"); };
  CHECK_THROWS_WITH(write_folder(made, other), Catch::Contains("name a folder that is new"));
  CHECK_THROWS_AS(refuse_taken(made / ""), InputError);
  CHECK(entries(made) == 1);
  CHECK(entries(made.parent_path()) == 1);

  const fs::path failed = folder.path / "other" / "failed";
  const auto fail = [&](const fs::path& temporary) {
    other(temporary);
    throw InputError("x", "", "y", "z");
  };
  CHECK_THROWS_AS(write_folder(failed, fail), InputError);
  CHECK_FALSE(fs::exists(failed.parent_path()));
  CHECK_THROWS_WITH(write_folder(made / "a" / "below", other), Catch::Contains("the folder cannot be written"));
  CHECK_THROWS_WITH(refuse_unwritable(made / "a" / "below"), Catch::Contains("the folder cannot be written"));
  refuse_unwritable(failed);
  CHECK_FALSE(fs::exists(failed.parent_path()));
  refuse_unwritable(made);
  CHECK(entries(made) == 1);
  CHECK(entries(made.parent_path()) == 1);
}

TEST_CASE("a held file is known under all its names, with the files beside it, until it is let go") {
  const TemporaryFolder folder;
  for (const char* name : {"lab.db", "other.db", "lab.db-wal"}) std::ofstream(folder.path / name) << "x";
  fs::create_hard_link(folder.path / "lab.db", folder.path / "link.db");
  auto first = hold_file(folder.path / "lab.db"), second = hold_file(folder.path / "lab.db");
  for (const char* name : {"lab.db", "link.db", "lab.db-wal", "lab.db-shm"}) CHECK(is_held(folder.path / name));
  for (const char* name : {"other.db", "missing", "lab.db-other"}) CHECK_FALSE(is_held(folder.path / name));
  first.reset();
  CHECK(is_held(folder.path / "lab.db"));
  second.reset();
  CHECK_FALSE(is_held(folder.path / "lab.db"));
  CHECK_FALSE(hold_file(folder.path / "missing"));
}

TEST_CASE("a picture is written as PNG or refused with its name") {
  const TemporaryFolder folder;
  write_png(folder.path / "grey.png", Image<std::uint8_t>(3, 2, 128));
  CHECK(read_file(folder.path / "grey.png").substr(1, 3) == "PNG");
  CHECK_THROWS_AS(write_png("/proc/none/grey.png", Image<std::uint8_t>(3, 2, 128)), InputError);
  const NoFilesToOpen limit;
  CHECK_THROWS_WITH(write_png(folder.path / "new.png", Image<std::uint8_t>(3, 2, 128)),
                    Catch::Contains("new.png: the picture cannot be written (Too many open files); check"));
}

TEST_CASE("a refusal is one line that is safe to show, whatever it quotes") {
  const InputError error("a\nb.toml", "key '\x1b[2J'", "it is '\xc2\x9b" + std::string(3000, 'x') + "\xc3\xa4'",
                         "\xc3\xa4");
  const std::string said = error.what();
  CHECK(said.find_first_of("\n\x1b") == std::string::npos);
  CHECK(said.find("\xc2\x9b") == std::string::npos);
  CHECK(said.starts_with("a b.toml: key ' [2J': it is '  xxx"));
  CHECK(said.ends_with("x...; \xc3\xa4."));
  CHECK(said.size() < 1100);
  // A character that does not fit is left out as a whole.
  CHECK(in_one_line(std::string(999, 'x') + "\xc3\xa4") == std::string(999, 'x') + "...");
  CHECK(in_one_line(std::string(998, 'x') + "\xc3\xa4") == std::string(998, 'x') + "\xc3\xa4");
}
