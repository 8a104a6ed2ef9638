#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

// The working files of a recording, from which its sequence file is made: what they are called and what is in them.

namespace insonate {

/// FILE.recording, which holds the frames' lines.
std::filesystem::path working_file(const std::filesystem::path& file);
/// FILE.recording.images, which holds their pictures, if there are any.
std::filesystem::path images_file(const std::filesystem::path& file);

/// The working file's first line, with the size of a picture or 0 0.
std::string working_head(int width, int height);

/// The line behind a frame's own: how far its picture reaches in the file of images, and the Adler-32 of all pictures
/// up to there.
std::string frame_end(std::uint64_t image_bytes, unsigned long adler);

/// Throws InputError when the sequence file, or a working file that its recording left behind, is there already.
void refuse_existing(const std::filesystem::path& file);

/// The pictures first: without the other file nobody could tell what they are of.
void remove_working_files(const std::filesystem::path& file);

/// Makes the sequence file `file` of the working files that lie beside it, up to the last frame that is there as a
/// whole, removes those and returns how many frames it has. Takes the same memory however long the recording is. If
/// `file` is there already and is that very sequence, only the working files are removed: the program was killed before
/// it came to that. Throws InputError when there is no such working file, when it is none, when it is still being
/// recorded to, when it holds no whole frame (it stays then), or when `file` is there already and holds anything else.
std::size_t recover_recording(const std::filesystem::path& file);

}  // namespace insonate
