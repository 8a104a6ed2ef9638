#include "sim/phantom/arithmetic.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace insonate {
namespace {

struct UnknownName {
  std::string name;
};

// Recursive descent: sum = product {(+|-) product}, product = factor {(*|/) factor}.
class Parser {
public:
  Parser(const std::string& text, const std::map<std::string, double>& values) : text_(text), values_(values) {}

  double whole() {
    const double value = sum();
    if (peek() != '\0') fail("something is left over");
    return value;
  }

private:
  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error(why + " at character " + std::to_string(at_ + 1));
  }

  char peek() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }

  void expect(char c) {
    if (!take(c)) fail(std::string("'") + c + "' is missing");
  }

  double sum() {
    double value = product();
    for (;;) {
      if (take('+'))
        value += product();
      else if (take('-'))
        value -= product();
      else
        return value;
    }
  }

  double product() {
    double value = factor();
    for (;;) {
      if (take('*'))
        value *= factor();
      else if (take('/'))
        value /= factor();
      else
        return value;
    }
  }

  double factor() {
    if (++depth_ > 50) fail("it is nested too deep");
    const double value = unguarded_factor();
    --depth_;
    return value;
  }

  double unguarded_factor() {
    if (take('-')) return -factor();
    if (take('(')) {
      const double value = sum();
      expect(')');
      return value;
    }
    const char c = peek();
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) return named();
    double value = 0;
    const char* begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (error != std::errc()) fail("a number or a name is missing");
    at_ += std::size_t(end - begin);
    return value;
  }

  double named() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
      ++at_;
    const std::string name = text_.substr(begin, at_ - begin);
    if (name == "min" || name == "max") {
      expect('(');
      const double a = sum();
      expect(',');
      const double b = sum();
      expect(')');
      return name == "min" ? std::min(a, b) : std::max(a, b);
    }
    const auto found = values_.find(name);
    if (found == values_.end()) throw UnknownName{name};
    return found->second;
  }

  const std::string& text_;
  const std::map<std::string, double>& values_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

ArithmeticResult evaluate_arithmetic(const std::string& expression, const std::map<std::string, double>& values) {
  ArithmeticResult result;
  try {
    const double value = Parser(expression, values).whole();
    if (std::isfinite(value))
      result.value = value;
    else
      result.problem = "it divides by zero or is too large";
  } catch (const UnknownName& unknown) {
    result.unknown_name = unknown.name;
  } catch (const std::runtime_error& error) {
    result.problem = error.what();
  }
  return result;
}

std::optional<double> parse_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace insonate
