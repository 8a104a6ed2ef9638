#pragma once

#include <cstddef>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"

namespace insonate::gl {

/// Model W's stages from the scan lines to the pixels, compiled, and the scans that they exchange.
///
/// In a scan, images either follow each other or are interleaved, with the same sample of four images in one texel.
/// With many images, interleaving saves three of four fetches, from which a software renderer gains. With a single
/// image, it would waste memory. Both variants are compiled, so that neither pays for the other.
struct ScanStages {
  static constexpr std::size_t kInterleaved = 4;

  /// What a traversal stores: the grey of a picture, both terms, or, for checks, the terms and the intensity.
  enum class Leaves { grey, terms, intensity };

  /// Throws std::runtime_error if a shader does not compile or the device's memory does not suffice for the scans.
  /// @param constants  the defines of wein/wein_parameters.h, except those that are added here
  /// @param interleaved    interleaved images: 1 or kInterleaved
  /// @param wanted_per_invocation  WorkDivision::images_per_invocation, rounded up here to a multiple of
  /// `interleaved`
  /// @param samples    capacity per image
  /// @param images     most images in a chunk, a multiple of `interleaved`
  ScanStages(const ShaderSources& sources, const Defines& constants, std::size_t interleaved, int wanted_per_invocation,
             std::size_t samples, std::size_t images);

  /// Builds the traversal.
  /// @param compiled_in  as the member of this name; with BENT, BEND_ACROSS and BEND_SAMPLES for lines that bend
  static Program traverse_program(const ShaderSources& sources, Defines compiled_in, Leaves leaves);

  /// Returns how many work groups `images` images take; each processes images_per_invocation of them.
  int image_groups(int images) const { return (images + images_per_invocation - 1) / images_per_invocation; }
  /// Returns how many groups of images with shared texels of terms `images` images form.
  int term_groups(int images) const { return (images + interleaved_terms - 1) / interleaved_terms; }

  int interleaved_terms;  ///< images whose terms share a texel: half of those whose greys do
  int images_per_invocation;
  Defines compiled_in;
  Program traverse_grey, traverse_terms, picture, parts;
  TexelBuffer grey_scan, term_scan;
};

}  // namespace insonate::gl
