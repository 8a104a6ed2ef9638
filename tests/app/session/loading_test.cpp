#include "app/session/loading.h"

#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>

using namespace insonate;

namespace {

/// So long a test waits for what must come, before it fails instead of standing still.
constexpr std::chrono::seconds kAtMost(60);

void until_nobody_works() {
  const auto end = std::chrono::steady_clock::now() + kAtMost;
  while (Loading::given_up() > 0 && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace

TEST_CASE("what is loaded is returned, with the progress on the way and what was thrown") {
  std::promise<void> begun, go_on;
  Loading loading([&](const LoadProgress& progress) {
    progress("Reading", 0.25);
    begun.set_value();
    go_on.get_future().wait();
    auto loaded_case = std::make_shared<LoadedCase>();
    loaded_case->subject.name = "Somebody";
    return loaded_case;
  });
  begun.get_future().wait();
  CHECK(loading.progress().what == "Reading");
  CHECK(loading.progress().share == 0.25);
  CHECK_FALSE(loading.done());
  go_on.set_value();
  CHECK(loading.take()->subject.name == "Somebody");
  CHECK(loading.done());
  CHECK(Loading::given_up() == 0);

  Loading failing(
      [](const LoadProgress&) -> std::shared_ptr<const LoadedCase> { throw std::runtime_error("no such thing"); });
  CHECK_THROWS_WITH(failing.take(), "no such thing");
}

TEST_CASE("giving up does not wait, and ends the work at the next progress it reports") {
  std::promise<void> begun, go_on;
  std::promise<bool> waited_for;
  std::atomic<bool> went_on = false;
  auto loading = std::make_unique<Loading>([&](const LoadProgress& progress) -> std::shared_ptr<const LoadedCase> {
    begun.set_value();
    // Nobody lets this go on before the Loading is destroyed: one that waited for its thread would wait all of that.
    waited_for.set_value(go_on.get_future().wait_for(kAtMost) == std::future_status::timeout);
    progress("The next part", 0.5);
    went_on = true;
    return {};
  });
  begun.get_future().wait();
  loading.reset();
  CHECK(Loading::given_up() == 1);
  go_on.set_value();
  CHECK_FALSE(waited_for.get_future().get());
  until_nobody_works();
  CHECK(Loading::given_up() == 0);
  CHECK_FALSE(went_on);
}

TEST_CASE("what was loaded after it was given up goes away with its thread") {
  struct Watched {
    explicit Watched(std::promise<void>* promise) : gone(promise) {}
    ~Watched() { gone->set_value(); }
    std::promise<void>* gone;
  };
  std::promise<void> begun, go_on, gone;
  auto watched = std::make_shared<Watched>(&gone);
  auto loading = std::make_unique<Loading>([&, watched = std::move(watched)](const LoadProgress&) {
    begun.set_value();
    go_on.get_future().wait();
    return std::make_shared<const LoadedCase>();
  });
  begun.get_future().wait();
  loading.reset();
  go_on.set_value();
  CHECK(gone.get_future().wait_for(kAtMost) == std::future_status::ready);
  until_nobody_works();
  CHECK(Loading::given_up() == 0);
}

TEST_CASE("the time left follows the share that is done, and is not shown before it can be known") {
  CHECK_FALSE(time_left_s(0.5, 0, 0.5));
  CHECK_FALSE(time_left_s(20, 0, 0.02));
  CHECK(time_left_s(10, 0, 0.25) == Approx(30));
  INFO("work that was half done when it was first looked at has shown a quarter of its pace");
  CHECK(time_left_s(10, 0.5, 0.75) == Approx(10));
  CHECK(time_left_s(10, 0, 1) == Approx(0));
}
