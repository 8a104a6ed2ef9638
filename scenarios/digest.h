#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sim/volume/case.h"

namespace insonate {

/// Names a content by 64 bits, to tell later whether two scores come from the same inputs. It finds accidents and old
/// versions; it does not stand against someone who wants a collision. FNV-1a (Fowler, Noll, Vo), over bytes.
class Digest {
public:
  void add(std::string_view bytes);
  void add(double number);
  std::string hex() const;  ///< 16 hexadecimal digits

private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

std::string digest_of(std::string_view bytes);

/// Of all that scoring reads of a case: grid, CT, labels, their names, landmarks and views.
std::string digest_of(const Case& subject);

}  // namespace insonate
