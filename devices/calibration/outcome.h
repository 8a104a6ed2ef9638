#pragma once

#include <optional>
#include <string>
#include <utility>

namespace insonate {

/// The reason why measurements cannot be used: one sentence for the person who made them, which states what to do.
struct Refusal {
  std::string sentence;
};

/// The result of measurements, or the reason why there is none. Unlike an InputError it is not exceptional: if a hand
/// slips, the step is repeated.
template <typename T>
class Outcome {
public:
  Outcome(T value) : value_(std::move(value)) {}
  Outcome(Refusal refusal) : refusal_(std::move(refusal.sentence)) {}

  explicit operator bool() const { return value_.has_value(); }
  const T& operator*() const { return *value_; }
  const T* operator->() const { return &*value_; }
  const std::string& refusal() const { return refusal_; }  ///< empty if there is a value

private:
  std::optional<T> value_;
  std::string refusal_;
};

}  // namespace insonate
