#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace insonate {

/// Which of several processes this one is, of those that one command has started.
struct Rank {
  std::uint32_t rank = 0, of = 1;
};

/// Returns the rank that Open MPI, a program with the PMI interface (MPICH, Intel MPI) or Slurm's srun has given this
/// process in its environment; {0, 1} without one. MPI itself is not needed: ranks do not talk. Throws InputError for
/// numbers that are not a rank.
Rank rank_of_environment();

/// Reads a list of shards as Slurm writes arrays: "3", "0-15", "1,4-6", "0-30:10". Throws InputError for anything else
/// and for shards that the dataset does not have.
/// @param option  what to call the list in error sentences
std::vector<std::uint32_t> read_shard_list(const std::string& option, const std::string& text, std::uint32_t shards);

/// Returns such a list of rising numbers.
std::string shard_list(const std::vector<std::uint32_t>& shards);

/// Returns the rank's part of the shards: neighbours, because neighbours mostly show the same patient.
std::vector<std::uint32_t> part_of(const std::vector<std::uint32_t>& shards, const Rank& rank);

}  // namespace insonate
