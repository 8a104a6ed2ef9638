#pragma once

#include <cstddef>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"

namespace insonate::gl {

/// Model W's stages from the scan lines to the pixels, compiled, and the scans that they hand on.
///
/// Images lie in a scan either one behind the other or four abreast, where a texel holds the same sample of all four:
/// of many images at once that is a fetch for four, which a software renderer gains by; of a single image it would be
/// room for nothing. Both are compiled, so that neither pays for the other.
struct ScanStages {
  static constexpr std::size_t kInterleaved = 4;

  /// What a walk along the lines leaves: the grey of a picture, both terms, or the terms and the intensity, for those
  /// who check.
  enum class Leaves { grey, terms, intensity };

  /// Throws std::runtime_error when shaders do not build or the device has no memory for the scans.
  /// @param constants  what shared/wein_parameters.h asks for but for what is added here
  /// @param abreast    1 or kInterleaved
  /// @param in_turn    WorkDivision::images_per_invocation, which is made a multiple of those abreast
  /// @param samples    that an image has room for
  /// @param images     at most in a chunk, a multiple of those abreast
  ScanStages(const ShaderSources& sources, const Defines& constants, std::size_t abreast, int in_turn,
             std::size_t samples, std::size_t images);

  /// @param compiled_in  as below
  static Program traverse_program(const ShaderSources& sources, Defines compiled_in, Leaves leaves);

  /// Work groups that so many images take, each a few in turn.
  int turns(int images) const { return (images + images_per_invocation - 1) / images_per_invocation; }
  /// Groups of images whose terms share texels, of so many.
  int term_groups(int images) const { return (images + interleaved_terms - 1) / interleaved_terms; }

  int interleaved_terms;  ///< images whose terms share a texel: half of those whose greys do
  int images_per_invocation;
  Defines compiled_in;
  Program traverse_grey, traverse_terms, picture, parts;
  TexelBuffer grey_scan, term_scan;
};

}  // namespace insonate::gl
