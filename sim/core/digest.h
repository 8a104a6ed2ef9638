#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace insonate {

/// Names a content by 16 hexadecimal digits, to tell later whether two scores come from the same inputs. It finds
/// accidents and old versions; it does not stand against someone who wants a collision (XXH3, 64 bits).
std::string digest_of(std::string_view bytes);

/// The same of a content that comes in pieces.
class Digest {
public:
  Digest();
  ~Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  void add(std::string_view bytes);
  /// What digest_of() says of all that was added.
  std::string text() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate
