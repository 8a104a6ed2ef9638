#pragma once

#include <filesystem>
#include <vector>

#include "sim/view/body/transfer_function.h"

namespace insonate::view {

/// Reads a transfer function that a person wrote or the trainer saved (TOML):
///
///     name = "Bones"
///
///     [[point]]
///     hu = 150                     # from -1024 to 3071, rising from point to point
///     colour = [0.86, 0.72, 0.60]  # sRGB, 0 to 1
///     opacity = 0                  # of 1 mm of tissue, 0 to 0.995
///
/// A function has 2 to kMaxTransferPoints points. Throws one InputError that names every mistake with its line.
TransferFunction read_transfer_function(const std::filesystem::path& toml_file);

inline constexpr std::size_t kMaxTransferPoints = 64;

/// Writes a function so that read_transfer_function() returns the same. Throws InputError if the file cannot be
/// written.
void write_transfer_function(const std::filesystem::path& toml_file, const TransferFunction& function);

/// Returns the functions that Insonate brings, in the order in which they are offered: those of the assets' folder
/// transfer_functions. Throws InputError if one cannot be read.
std::vector<TransferFunction> bundled_transfer_functions();

}  // namespace insonate::view
