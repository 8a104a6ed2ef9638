#include "sim/acoustics/transform.h"

#include <kissfft/kissfft.hh>

#include <algorithm>

namespace insonate {

struct Transform::Plans {
  std::size_t length;
  kissfft<double> forward, backward;
};

Transform::Transform(std::size_t length)
    : plans_(new Plans{length, kissfft<double>(length, false), kissfft<double>(length, true)}) {}
Transform::~Transform() = default;

std::size_t Transform::length() const {
  return plans_->length;
}

std::vector<std::complex<double>> Transform::forward(std::span<const double> samples) const {
  std::vector<std::complex<double>> padded(plans_->length), spectrum(plans_->length);
  std::copy_n(samples.begin(), std::min(samples.size(), padded.size()), padded.begin());
  plans_->forward.transform(padded.data(), spectrum.data());
  return spectrum;
}

std::vector<std::complex<double>> Transform::backward(const std::vector<std::complex<double>>& spectrum) const {
  std::vector<std::complex<double>> samples(plans_->length);
  plans_->backward.transform(spectrum.data(), samples.data());
  for (std::complex<double>& sample : samples) sample /= double(plans_->length);
  return samples;
}

std::size_t fast_length(std::size_t least) {
  for (std::size_t length = std::max<std::size_t>(least, 1);; ++length) {
    std::size_t rest = length;
    for (const std::size_t factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return length;
  }
}

}  // namespace insonate
