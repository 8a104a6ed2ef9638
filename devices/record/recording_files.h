#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

// Names and contents of a recording's working files, from which its sequence file is made.

namespace insonate {

/// Returns FILE.recording, which holds the frames' lines.
std::filesystem::path working_file(const std::filesystem::path& file);
/// Returns FILE.recording.images, which holds the frames' pictures, if there are any.
std::filesystem::path images_file(const std::filesystem::path& file);

/// Returns the first line of the working file, with the size of a picture, or 0 0.
std::string working_head(int width, int height);

/// Returns the line that ends a frame: the end of its picture in the images file in bytes, and the Adler-32 of all
/// pictures up to there.
std::string frame_end(std::uint64_t image_bytes, unsigned long adler);

/// Throws InputError if the sequence file, or a working file that a recording left behind, already exists.
void refuse_existing(const std::filesystem::path& file);

/// Removes the images file first, because it cannot be interpreted without the other file.
void remove_working_files(const std::filesystem::path& file);

/// Makes the sequence file `file` from its working files, up to the last complete frame, removes these and returns the
/// number of frames. Its memory use does not grow with the recording. If `file` already exists and is exactly that
/// sequence, it only removes the working files: the program was killed before it did so.
///
/// Throws InputError if there is no working file, if it is not one, or if it is still being recorded to. Also throws it
/// if the working file holds no complete frame (it is then kept), or if `file` already exists with other content.
std::size_t recover_recording(const std::filesystem::path& file);

}  // namespace insonate
