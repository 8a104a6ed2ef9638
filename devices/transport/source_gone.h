#pragma once

#include <stdexcept>

namespace insonate {

/// Thrown when a device cannot be used, or can no longer be used. what() is a sentence for users that states what to do
/// ("The tracker is not plugged in.").
class SourceGone : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

}  // namespace insonate
