#include "tools/render/stage_files.h"

#include <bit>

#include "sim/files/files.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

template <typename From>
Image<float> rounded(const Image<From>& image) {
  Image<float> to(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) to.pixels[i] = float(image.pixels[i]);
  return to;
}

}  // namespace

void write_nrrd(const fs::path& file, const Image<float>& image, const char* axes, const std::string& content) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes = "NRRD0004\ncontent: " + content +
                      "\ntype: float\ndimension: 2\nsizes: " + std::to_string(image.width) + " " +
                      std::to_string(image.height) + "\nlabels: " + axes + "\nendian: little\nencoding: raw\n\n";
  bytes.append(reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size() * sizeof(float));
  write_file(file, bytes);
}

void write_among_lines(const fs::path& folder, const char* name, const Image<float>& image,
                       const std::string& content) {
  write_nrrd(folder / (std::string(name) + ".nrrd"), image, "\"line\" \"sample\"", content);
}

void write_as_picture(const fs::path& folder, const char* name, const Image<float>& image, const std::string& content) {
  write_nrrd(folder / (std::string(name) + ".nrrd"), image, "\"x\" \"y\"", content);
}

Image<float> in_single_precision(const Image<double>& image) {
  return rounded(image);
}

Image<float> in_single_precision(const Image<std::uint8_t>& image) {
  return rounded(image);
}

}  // namespace insonate
