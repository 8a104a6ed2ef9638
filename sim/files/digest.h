#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace insonate {

/// Returns a digest of `bytes` as 16 hexadecimal digits (XXH3, 64 bits). It shows later whether two scores come from
/// the same inputs. It detects accidents and old versions; it does not resist deliberate collisions.
std::string digest_of(std::string_view bytes);

/// Computes the same digest for content that arrives in pieces.
class Digest {
public:
  Digest();
  ~Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  void add(std::string_view bytes);
  /// Returns what digest_of() returns for everything added so far.
  std::string text() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate
