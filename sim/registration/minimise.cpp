#include "sim/registration/minimise.h"

#include <nlopt.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace insonate {
namespace {

// One local search on a thread of its own, which waits wherever it needs a value.
struct Runner {
  enum class State { thinking, asking, answered, ended };
  State state = State::thinking;
  Parameters asked;
  double answer = 0;
  Optimum found;
  std::string failure;
};

class Runners {
public:
  Runners(const std::vector<Parameters>& starts, const LocalSearch& search) : runners_(starts.size()) {
    try {
      for (std::size_t i = 0; i < starts.size(); ++i)
        threads_.emplace_back(
            [this, &search, &runner = runners_[i], start = starts[i]] { run(runner, start, search); });
    } catch (...) {  // the system has no more threads
      stop();
      throw;
    }
  }
  ~Runners() { stop(); }

  std::vector<Optimum> finish(const EvaluateAll& evaluate) {
    for (;;) {
      std::vector<Parameters> points;
      std::vector<Runner*> asking;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] {
          return std::ranges::all_of(runners_, [](const Runner& r) {
            return r.state == Runner::State::asking || r.state == Runner::State::ended;
          });
        });
        for (Runner& runner : runners_)
          if (runner.state == Runner::State::asking) {
            points.push_back(runner.asked);
            asking.push_back(&runner);
          }
      }
      if (points.empty()) break;
      const std::vector<double> values = evaluate(points);
      {
        const std::lock_guard lock(mutex_);
        for (std::size_t i = 0; i < asking.size(); ++i) {
          asking[i]->answer = values[i];
          asking[i]->state = Runner::State::answered;
        }
      }
      changed_.notify_all();
    }
    std::vector<Optimum> found;
    for (const Runner& runner : runners_) {
      if (!runner.failure.empty()) throw std::runtime_error("NLopt: " + runner.failure);
      found.push_back(runner.found);
    }
    return found;
  }

private:
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      abandoned_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

  struct Asking {
    Runners& runners;
    Runner& runner;
  };

  double ask(Runner& runner, const Parameters& at) {
    std::unique_lock lock(mutex_);
    runner.asked = at;
    runner.state = Runner::State::asking;
    changed_.notify_all();
    changed_.wait(lock, [&] { return abandoned_ || runner.state == Runner::State::answered; });
    if (abandoned_) throw nlopt::forced_stop();
    runner.state = Runner::State::thinking;
    ++runner.found.evaluations;
    if (runner.found.at.empty() || runner.answer > runner.found.value) {
      runner.found.at = at;
      runner.found.value = runner.answer;
    }
    return runner.answer;
  }

  void run(Runner& runner, Parameters at, const LocalSearch& search) {
    try {
      nlopt::opt optimiser(nlopt::LN_BOBYQA, unsigned(at.size()));
      optimiser.set_lower_bounds(search.low);
      optimiser.set_upper_bounds(search.high);
      optimiser.set_initial_step(search.first_step);
      optimiser.set_xtol_abs(search.tolerance);
      optimiser.set_maxeval(search.most_evaluations);
      Asking asking{*this, runner};
      optimiser.set_max_objective(
          [](const Parameters& x, Parameters&, void* data) {
            const auto& from = *static_cast<Asking*>(data);
            return from.runners.ask(from.runner, x);
          },
          &asking);
      for (std::size_t i = 0; i < at.size(); ++i) at[i] = std::clamp(at[i], search.low[i], search.high[i]);
      double value = 0;
      const nlopt::result result = optimiser.optimize(at, value);
      runner.found.within_tolerance = result != nlopt::MAXEVAL_REACHED;
    } catch (const nlopt::roundoff_limited&) {
      runner.found.within_tolerance = true;  // the best point does not differ from its neighbours
    } catch (const nlopt::forced_stop&) {
      // Abandoned: nobody reads the result.
    } catch (const std::exception& error) {
      runner.failure = error.what();
    }
    {
      const std::lock_guard lock(mutex_);
      runner.state = Runner::State::ended;
    }
    changed_.notify_all();
  }

  std::vector<Runner> runners_;
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool abandoned_ = false;
};

double halton(std::size_t index, std::size_t base) {
  double value = 0, share = 1;
  for (; index > 0; index /= base) {
    share /= double(base);
    value += share * double(index % base);
  }
  return value;
}

}  // namespace

std::vector<Optimum> maximise_from(const std::vector<Parameters>& starts, const EvaluateAll& evaluate,
                                   const LocalSearch& search) {
  return Runners(starts, search).finish(evaluate);
}

bool leads_up(const Optimum& from, const Optimum& to, const EvaluateAll& evaluate) {
  constexpr double kLevel = 0.98;
  constexpr int kSteps = 8;
  if (from.value > kLevel * to.value) return false;
  std::vector<Parameters> way;
  for (int step = 1; step < kSteps; ++step) {
    way.push_back(from.at);
    for (std::size_t i = 0; i < from.at.size(); ++i) way.back()[i] += (to.at[i] - from.at[i]) * step / kSteps;
  }
  return std::ranges::min(evaluate(way)) >= kLevel * from.value;
}

std::vector<Parameters> scattered_motions(std::size_t first, std::size_t count, double translation_mm,
                                          double rotation_mm) {
  constexpr std::array<std::size_t, 6> kBases{2, 3, 5, 7, 11, 13};
  std::vector<Parameters> points;
  std::size_t passed = 0;
  for (std::size_t index = 1; points.size() < count; ++index) {
    Parameters point;
    std::array<double, 2> squares{};
    for (std::size_t i = 0; i < kBases.size(); ++i) {
      point.push_back(2 * halton(index, kBases[i]) - 1);
      squares[i / 3] += point.back() * point.back();
    }
    if (squares[0] > 1 || squares[1] > 1 || passed++ < first) continue;
    for (std::size_t i = 0; i < point.size(); ++i)
      point[i] *= std::sqrt(squares[i / 3]) * (i < 3 ? translation_mm : rotation_mm);
    points.push_back(std::move(point));
  }
  return points;
}

}  // namespace insonate
