#include "tools/dataset/ranks.h"

#include <catch2/catch.hpp>

#include <cstdlib>

#include "sim/core/input_error.h"

using namespace insonate;
using List = std::vector<std::uint32_t>;

namespace {

/// Sets variables of the environment for one test, and removes all that name a rank.
struct Environment {
  static constexpr const char* kNames[] = {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "PMI_RANK",    "PMI_SIZE",
                                           "SLURM_PROCID",         "SLURM_STEP_NUM_TASKS", "SLURM_NTASKS"};
  Environment() { clear(); }
  ~Environment() { clear(); }
  static void clear() {
    for (const char* name : kNames) unsetenv(name);
  }
};

std::string why_refused(const std::string& list) {
  try {
    read_shard_list("--shards", list, 100);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("lists of shards are those of Slurm's arrays") {
  CHECK(read_shard_list("--shards", "3", 100) == List{3});
  CHECK(read_shard_list("--shards", "0-3,7,5-6", 100) == List{0, 1, 2, 3, 5, 6, 7});
  CHECK(read_shard_list("--shards", "0-30:10", 100) == List{0, 10, 20, 30});
  CHECK(read_shard_list("--shards", "4,4,3-5", 100) == List{3, 4, 5});
  CHECK(read_shard_list("--shards", "5-6:4294967295,8-99:4294967290", 100) == List{5, 8});
  CHECK(shard_list({0, 1, 2, 5, 7, 8}) == "0-2,5,7-8");
  CHECK(shard_list({}) == "");
  for (const char* const wrong :
       {"", "a", "3-", "-3", "5-3", "1,,2", "1,", "0-9:0", "0-9:", "3:x", "99999999999", " 1"}) {
    INFO(wrong);
    CHECK(why_refused(wrong).find("is not a shard, a range") != std::string::npos);
  }
  CHECK(why_refused("98-100").find("there is no shard 100 of 100; count them from 0") != std::string::npos);
}

TEST_CASE("ranks share a list without gaps and without overlap, in neighbours") {
  for (const std::uint32_t count : {0u, 1u, 7u, 16u, 100u})
    for (const std::uint32_t of : {1u, 2u, 3u, 8u, 33u}) {
      List all, dealt;
      for (std::uint32_t i = 0; i < count; ++i) all.push_back(2 * i);
      for (std::uint32_t rank = 0; rank < of; ++rank) {
        const List part = part_of(all, {rank, of});
        CHECK(part.size() <= count / of + 1);
        dealt.insert(dealt.end(), part.begin(), part.end());
      }
      CHECK(dealt == all);
    }
}

TEST_CASE("the rank is that of mpirun or srun, and a batch script without srun is alone") {
  const Environment cleared;
  CHECK(rank_of_environment().of == 1);
  setenv("SLURM_PROCID", "0", 1);
  setenv("SLURM_NTASKS", "4", 1);
  CHECK(rank_of_environment().of == 1);
  setenv("SLURM_PROCID", "3", 1);
  setenv("SLURM_STEP_NUM_TASKS", "4", 1);
  CHECK(rank_of_environment().rank == 3);
  CHECK(rank_of_environment().of == 4);
  setenv("PMI_RANK", "1", 1);
  setenv("PMI_SIZE", "5", 1);
  CHECK(rank_of_environment().of == 5);
  setenv("OMPI_COMM_WORLD_RANK", "5", 1);
  setenv("OMPI_COMM_WORLD_SIZE", "6", 1);
  CHECK(rank_of_environment().rank == 5);
  for (const char* const wrong : {"6", "-1", "x", ""}) {
    setenv("OMPI_COMM_WORLD_RANK", wrong, 1);
    CHECK_THROWS_AS(rank_of_environment(), InputError);
  }
}
