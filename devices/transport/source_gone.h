#pragma once

#include <stdexcept>

namespace insonate {

/// A device cannot be used now, or no longer: what() is a sentence for people that says what to do ("The tracker is not
/// plugged in.").
class SourceGone : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

}  // namespace insonate
