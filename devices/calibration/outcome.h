#pragma once

#include <optional>
#include <string>
#include <utility>

namespace insonate {

/// Why measurements cannot be used: one sentence, for whoever made them, that says what to do.
struct Refusal {
  std::string sentence;
};

/// What measurements say, or why they say nothing. Other than an InputError it is nothing exceptional: a hand that
/// slips is asked again.
template <typename T>
class Outcome {
public:
  Outcome(T value) : value_(std::move(value)) {}
  Outcome(Refusal refusal) : refusal_(std::move(refusal.sentence)) {}

  explicit operator bool() const { return value_.has_value(); }
  const T& operator*() const { return *value_; }
  const T* operator->() const { return &*value_; }
  const std::string& refusal() const { return refusal_; }  ///< empty when there is a value

private:
  std::optional<T> value_;
  std::string refusal_;
};

}  // namespace insonate
